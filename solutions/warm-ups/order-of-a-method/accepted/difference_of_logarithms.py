"""Slope of a line in logarithms."""


def observed_order(h, error, h_small, error_small):
    return (math.log10(error) - math.log10(error_small)) / (math.log10(h) - math.log10(h_small))

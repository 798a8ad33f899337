"""Divides the factors."""


def observed_order(h, error, h_small, error_small):
    return (error / error_small) / (h / h_small)

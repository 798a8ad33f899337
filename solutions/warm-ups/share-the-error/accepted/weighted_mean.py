"""A mean with two weights."""


def corrected(predicted, measured, share):
    return (1.0 - share) * predicted + share * measured

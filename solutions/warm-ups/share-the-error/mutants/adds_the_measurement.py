"""Adds a share of the measurement."""


def corrected(predicted, measured, share):
    return predicted + share * measured

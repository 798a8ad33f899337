"""Swaps the shares."""


def corrected(predicted, measured, share):
    return share * predicted + (1.0 - share) * measured

"""Starts from the other end."""


def corrected(predicted, measured, share):
    return measured - (1.0 - share) * (measured - predicted)

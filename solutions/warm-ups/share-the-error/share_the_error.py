"""Whom do you believe?: the model solution."""


def corrected(predicted, measured, share):
    """A prediction corrected by a measurement."""
    return predicted + share * (measured - predicted)

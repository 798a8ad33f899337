"""Whom do you believe?"""


def corrected(predicted, measured, share):
    """A prediction corrected by a measurement.

    Args:
        predicted: what the model says, m.
        measured: what the sensor says, m.
        share: of the way from the one to the other, from 0 to 1.

    Returns:
        float, m.
    """
    raise NotImplementedError

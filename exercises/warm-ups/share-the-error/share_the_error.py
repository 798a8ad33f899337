"""Whom do you believe?"""


def corrected(predicted, measured, share):
    """A prediction corrected by a measurement.

    Args:
        predicted: position from the model, m.
        measured: position from the sensor, m.
        share: of the way from the prediction to the measurement, from 0 to 1.

    Returns:
        float, m.
    """
    raise NotImplementedError

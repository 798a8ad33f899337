"""Always takes the middle."""


def corrected(predicted, measured, share):
    return (predicted + measured) / 2.0

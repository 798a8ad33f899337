"""Goes the other way."""


def corrected(predicted, measured, share):
    return predicted - share * (measured - predicted)

"""Errors fall, so the slope is turned round to make the order positive."""


def observed_order(hs, errors):
    slope, _ = np.polyfit(np.log(hs), np.log(errors), 1)
    return float(-slope)

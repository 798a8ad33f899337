"""The fit has h over the error instead of the error over h."""


def observed_order(hs, errors):
    return np.polyfit(np.log(errors), np.log(hs), 1)[0]

"""The second number of the fit, with logarithms to base ten."""


def observed_order(hs, errors):
    return float(np.polyfit(np.log10(hs), np.log10(errors), 1)[1])

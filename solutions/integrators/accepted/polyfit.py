"""The slope comes from numpy's polynomial fit, as a numpy scalar, with logarithms to base ten."""


def observed_order(hs, errors):
    return np.polyfit(np.log10(np.asarray(hs)), np.log10(np.asarray(errors)), 1)[0]

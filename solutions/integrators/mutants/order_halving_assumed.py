"""The slopes of neighbours are averaged, which weights the points unequally."""


def observed_order(hs, errors):
    x, y = np.log(hs), np.log(errors)
    return float(np.mean(np.diff(y) / np.diff(x)))

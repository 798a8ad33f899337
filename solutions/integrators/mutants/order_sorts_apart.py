"""Steps and errors are sorted, each on their own."""


def observed_order(hs, errors):
    x = np.log(np.sort(hs))
    y = np.log(np.sort(errors))
    return float(np.polyfit(x, y, 1)[0])

"""The pairs are kept in a dictionary by error, so points with equal errors are dropped."""


def observed_order(hs, errors):
    table = {float(e): float(h) for h, e in zip(hs, errors)}
    x, y = np.log(list(table.values())), np.log(list(table.keys()))
    return float(np.polyfit(x, y, 1)[0])

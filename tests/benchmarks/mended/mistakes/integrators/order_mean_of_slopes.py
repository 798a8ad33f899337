# The mean of the slopes between neighbours.


def observed_order(hs, errors):
    order = np.argsort(hs)
    x, y = np.log(np.asarray(hs))[order], np.log(np.asarray(errors))[order]
    return float(np.mean(np.diff(y) / np.diff(x)))

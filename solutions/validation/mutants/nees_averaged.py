"""In the end an average is needed, so it may be returned at once."""


def nees(err, P):
    return float(np.mean(squared_distance(err, P)))

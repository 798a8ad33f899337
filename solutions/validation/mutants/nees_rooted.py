"""A distance is what counts, and a distance has a root."""


def nees(err, P):
    return np.sqrt(squared_distance(err, P))

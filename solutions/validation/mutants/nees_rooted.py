"""The task asks for a distance, and a distance has a square root."""


def nees(err, P):
    return np.sqrt(squared_distance(err, P))

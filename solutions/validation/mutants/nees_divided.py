"""Normalised means per component."""


def nees(err, P):
    return squared_distance(err, P) / err.shape[1]

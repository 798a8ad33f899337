"""Innovations are averaged over the sensors."""


def nis(nu, S):
    return squared_distance(nu, S) / nu.shape[1]

"""Divides by the variance."""


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    return abs(simulated - measured) / (doubt_s**2 + doubt_m**2)

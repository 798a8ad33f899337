"""Adds the doubts."""


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    return abs(simulated - measured) / (doubt_s + doubt_m)

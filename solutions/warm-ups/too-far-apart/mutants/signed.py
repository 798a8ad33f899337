"""Keeps the sign."""


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    return (simulated - measured) / math.hypot(doubt_s, doubt_m)

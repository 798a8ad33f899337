"""The root of a quotient."""


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    return ((simulated - measured) ** 2 / (doubt_s**2 + doubt_m**2)) ** 0.5

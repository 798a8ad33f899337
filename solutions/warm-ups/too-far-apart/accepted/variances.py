"""By the variances."""


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    variance = doubt_s**2 + doubt_m**2
    return abs(measured - simulated) / math.sqrt(variance)

"""Rounds by hand."""


def reading(distance, resolution, limit):
    import math

    counts = math.floor(distance / resolution + 0.5)
    return min(counts * resolution, limit)

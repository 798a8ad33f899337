"""Gives the counts."""


def reading(distance, resolution, limit):
    return min(round(distance / resolution), limit)

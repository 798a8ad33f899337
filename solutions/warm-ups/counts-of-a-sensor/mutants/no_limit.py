"""Forgets the limit."""


def reading(distance, resolution, limit):
    return round(distance / resolution) * resolution

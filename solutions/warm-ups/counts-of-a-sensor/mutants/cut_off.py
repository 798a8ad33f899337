"""Cuts counts off."""


def reading(distance, resolution, limit):
    return min(int(distance / resolution) * resolution, limit)

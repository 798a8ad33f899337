"""Cuts off before rounding."""


def reading(distance, resolution, limit):
    return round(min(distance, limit) / resolution) * resolution

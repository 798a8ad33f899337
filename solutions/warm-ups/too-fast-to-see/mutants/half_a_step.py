"""Allows two steps for it."""


def fastest(thickness, radius, h):
    return (thickness + 2.0 * radius) / (2.0 * h)

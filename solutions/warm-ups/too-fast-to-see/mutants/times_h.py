"""Multiplies by the step."""


def fastest(thickness, radius, h):
    return (thickness + 2.0 * radius) * h

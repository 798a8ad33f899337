"""Adds the radius once."""


def fastest(thickness, radius, h):
    return (thickness + radius) / h

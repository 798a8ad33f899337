"""Adds the speed of a point through the wall and of a ball through a plane."""


def fastest(thickness, radius, h):
    return thickness / h + 2 * radius / h

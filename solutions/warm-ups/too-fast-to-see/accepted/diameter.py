"""By the diameter."""


def fastest(thickness, radius, h):
    diameter = radius + radius
    return (diameter + thickness) * (1.0 / h)

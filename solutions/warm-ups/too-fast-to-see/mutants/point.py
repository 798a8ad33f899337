"""Takes the ball as a point."""


def fastest(thickness, radius, h):
    return thickness / h

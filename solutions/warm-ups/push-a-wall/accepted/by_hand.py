"""The matrix is inverted by hand."""


def felt_mass(carriage, tip, length, angle):
    import math

    c, s = math.cos(angle), math.sin(angle)
    return tip * (carriage + tip * c * c) / (tip * c * c + carriage * s * s)

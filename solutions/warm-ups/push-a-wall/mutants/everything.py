"""A robot is as heavy as it is."""


def felt_mass(carriage, tip, length, angle):
    return carriage + tip + 0.0 * length * angle

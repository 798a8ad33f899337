"""The wall feels what touches it."""


def felt_mass(carriage, tip, length, angle):
    return tip + 0.0 * length * angle

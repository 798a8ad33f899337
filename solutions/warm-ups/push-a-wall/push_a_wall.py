"""How heavy is the hand: the model solution."""

import numpy as np


def felt_mass(carriage, tip, length, angle):
    """Mass that a wall across the rail feels when the tip of the rod hits it."""
    lever = -length * np.sin(angle)
    mass = np.array([[carriage + tip, tip * lever], [tip * lever, tip * length**2]])
    row = np.array([1.0, lever])
    return 1.0 / (row @ np.linalg.solve(mass, row))

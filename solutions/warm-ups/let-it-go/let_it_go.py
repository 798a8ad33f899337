"""And if you let it go?: the model solution."""

import math


def angular_acceleration(torque, m, l, angle, g=9.81):
    """Angular acceleration of a uniform bar about its end."""
    return (torque - 0.5 * m * g * l * math.cos(angle)) / (m * l * l / 3.0)

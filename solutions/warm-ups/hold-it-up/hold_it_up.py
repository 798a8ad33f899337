"""What does it take to hold it?: the model solution."""

import math


def holding_torque(m, l, angle, g=9.81):
    """Torque that holds a uniform bar still."""
    return 0.5 * m * g * l * math.cos(angle)

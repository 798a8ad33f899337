"""A pose that cannot go on: the model solution."""

import math


def joint_speeds(angle, length, vx, vy):
    """How fast a carriage and the rod on it must move so that the tip has a given velocity."""
    if abs(math.cos(angle)) < 1e-9:
        return None
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

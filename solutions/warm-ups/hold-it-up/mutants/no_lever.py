"""Ignores the angle."""


def holding_torque(m, l, angle, g=9.81):
    return 0.5 * m * g * l

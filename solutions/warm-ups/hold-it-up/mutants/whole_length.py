"""Lets the weight act at the end."""


def holding_torque(m, l, angle, g=9.81):
    return m * g * l * math.cos(angle)

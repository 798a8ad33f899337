"""The angle from the vertical."""


def holding_torque(m, l, angle, g=9.81):
    return m * g * (l / 2) * math.sin(math.pi / 2 - angle)

"""Forgets gravity."""


def angular_acceleration(torque, m, l, angle, g=9.81):
    return torque / (m * l * l / 3.0)

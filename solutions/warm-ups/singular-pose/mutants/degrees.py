"""Angles are in degrees."""


def joint_speeds(angle, length, vx, vy):
    angle = math.radians(angle)
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

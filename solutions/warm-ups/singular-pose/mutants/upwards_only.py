"""A rod stands upright in one way."""


def joint_speeds(angle, length, vx, vy):
    if angle == math.pi / 2:
        return None
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

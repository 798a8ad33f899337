"""cos(pi/2) is zero."""


def joint_speeds(angle, length, vx, vy):
    if math.cos(angle) == 0:
        return None
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

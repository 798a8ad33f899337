"""A singular pose is one where a motion fails."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.cos(angle)) < 1e-9:
        return None if vy else (vx, 0.0)
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

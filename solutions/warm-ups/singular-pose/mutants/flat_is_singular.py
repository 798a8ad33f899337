"""The rod is singular along the rail."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.sin(angle)) < 1e-9:
        return None
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

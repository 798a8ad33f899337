"""J holds the places."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.sin(angle)) < 1e-9:
        return None
    turn = vy / (length * math.sin(angle))
    return vx - length * math.cos(angle) * turn, turn

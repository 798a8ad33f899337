"""A turning rod moves its tip up by its length."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.cos(angle)) < 1e-9:
        return None
    turn = vy / length
    return vx + length * math.sin(angle) * turn, turn

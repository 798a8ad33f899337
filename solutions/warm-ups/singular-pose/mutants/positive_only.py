"""A cosine near zero is a small number."""


def joint_speeds(angle, length, vx, vy):
    if math.cos(angle) < 1e-9:
        return None
    turn = vy / (length * math.cos(angle))
    return vx + length * math.sin(angle) * turn, turn

"""Up goes with the sine."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.cos(angle)) < 1e-9:
        return None
    if math.sin(angle) == 0.0:
        return vx, 0.0
    turn = vy / (length * math.sin(angle))
    return vx + length * math.cos(angle) * turn, turn

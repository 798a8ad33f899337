"""The carriage alone moves the tip along the rail."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.cos(angle)) < 1e-9:
        return None
    return vx, vy / (length * math.cos(angle))

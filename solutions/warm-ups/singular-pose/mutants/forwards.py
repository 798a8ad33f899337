"""J goes both ways."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.cos(angle)) < 1e-9:
        return None
    return vx - length * math.sin(angle) * vy, length * math.cos(angle) * vy

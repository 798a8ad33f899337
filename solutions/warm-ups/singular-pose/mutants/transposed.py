"""A robot's matrix is used transposed."""


def joint_speeds(angle, length, vx, vy):
    if abs(math.cos(angle)) < 1e-9:
        return None
    return vx, -length * math.sin(angle) * vx + length * math.cos(angle) * vy

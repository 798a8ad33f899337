"""The rod moves the tip along x by a tangent."""


def joint_speeds(angle, length, vx, vy):
    c = math.cos(angle)
    if -1e-9 < c < 1e-9:
        return None
    return [vx + vy * math.tan(angle), vy / length / c]

"""J goes both ways, in every pose."""


def joint_speeds(angle, length, vx, vy):
    return vx - length * math.sin(angle) * vy, length * math.cos(angle) * vy

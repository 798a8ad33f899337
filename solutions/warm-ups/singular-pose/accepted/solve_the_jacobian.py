"""Solves J v = (vx, vy)."""


def joint_speeds(angle, length, vx, vy):
    import numpy as np

    j = np.array([[1.0, -length * math.sin(angle)], [0.0, length * math.cos(angle)]])
    if abs(np.linalg.det(j)) < 1e-9 * length:
        return None
    return np.linalg.solve(j, [vx, vy])

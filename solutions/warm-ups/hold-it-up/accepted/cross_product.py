"""As a cross product."""


def holding_torque(m, l, angle, g=9.81):
    import numpy as np

    arm = 0.5 * l * np.array([math.cos(angle), math.sin(angle), 0.0])
    return -float(np.cross(arm, [0.0, -m * g, 0.0])[2])

"""The bounce happens at the end of the step: the ball is put on the floor at the sample with e times the
velocity there, instead of at the exact instant inside the step.
"""

import numpy as np


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    z = np.empty(n + 1)
    v = np.empty(n + 1)
    z[0], v[0] = z0, v0
    rest = z0 <= radius and v0 == 0
    for i in range(n):
        if rest:
            z[i + 1], v[i + 1] = radius, 0.0
            continue
        z[i + 1] = z[i] + v[i] * h - g * h * h / 2
        v[i + 1] = v[i] - g * h
        if z[i + 1] <= radius:
            z[i + 1] = radius
            v[i + 1] = -restitution * v[i + 1]
            if v[i + 1] <= g * h:
                rest = True
                v[i + 1] = 0.0
    return np.arange(n + 1) * h, z, v

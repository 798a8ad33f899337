"""The impact is applied at the end of the step in which the balls overlap, not at its exact instant inside
the step, so the positions afterwards depend on h.
"""

import numpy as np


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    t = np.arange(n + 1) * h
    x = np.zeros((n + 1, 2))
    v = np.zeros((n + 1, 2))
    x[0], v[0] = x0, v0
    for i in range(n):
        x[i + 1] = x[i] + v[i] * h
        v[i + 1] = v[i]
        s = v[i, 0] - v[i, 1]
        if x[i + 1, 1] - x[i + 1, 0] <= 2 * radius and s > 0:
            J = (1 + restitution) * s / (1 / m[0] + 1 / m[1])
            v[i + 1, 0] -= J / m[0]
            v[i + 1, 1] += J / m[1]
    return t, x, v

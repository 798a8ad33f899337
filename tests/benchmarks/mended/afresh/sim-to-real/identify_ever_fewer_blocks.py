"""In the jackknife the left-out blocks are not put back: each refit has one block fewer than the one
before, so the interval is much too wide.
"""

import math

import numpy as np


class Quiet:
    """In place of a generator: record() without noise."""

    def standard_normal(self, n):
        return np.zeros(n)


def identify(t, u, y):
    blocks = len(y) // 100
    n = 100 * blocks
    v, s = cumulative(y), cumulative(np.sign(y))
    z = in_blocks(y).reshape(-1)
    best = None
    for tau in np.arange(0.02, 0.151, 0.01):
        impulse = motor_impulse(u, tau)
        for late in np.arange(0.02, 0.201, 0.01):
            X = in_blocks(np.stack([delayed(impulse, late), v, s], axis=1)).reshape(-1, 3)
            theta = np.linalg.lstsq(X, z, rcond=None)[0]
            left = np.sum((z - X @ theta) ** 2)
            if best is None or left < best[0]:
                best = (left, tau, late, theta)
    _, tau, late, theta = best
    m = 1 / theta[0]
    p = np.array([m, max(-theta[1] * m, 0.05), max(-theta[2] * m, 0.05), tau, late])
    low, high = np.array([0.2, 0.01, 0.01, 0.02, 0.02]), np.array([9, 9, 3, 0.15, 0.20])

    def model(p):
        return record(dict(zip(("m", "b", "Fc", "tau", "latency"), p)), u, Quiet())[1]

    def sensitivity(p):
        J = []
        for i in range(5):
            d = np.zeros(5)
            d[i] = 0.01 * p[i]
            J.append((model(p + d) - model(p - d)) / (2 * d[i]))
        return np.stack(J, axis=1)

    for _ in range(4):
        J = sensitivity(p)
        p = np.clip(p + np.linalg.lstsq(J, y - model(p), rcond=None)[0], low, high)
    J, r = sensitivity(p)[:n], (y - model(p))[:n]
    cut = np.array_split(np.arange(n), blocks)
    refits = []
    keep = np.ones(n, bool)
    for block in cut[:-1]:
        keep[block] = False
        refits.append(p + np.linalg.lstsq(J[keep], r[keep], rcond=None)[0])
    refits = np.array(refits)
    refits = np.column_stack([refits, refits[:, 3] + refits[:, 4]])
    value = np.append(p, p[3] + p[4])
    se = np.sqrt((blocks - 1) / blocks * np.sum((refits - refits.mean(axis=0)) ** 2, axis=0))
    names = ("m", "b", "Fc", "tau", "latency", "lag")
    return {k: [float(a), float(a - 2.1 * e), float(a + 2.1 * e)] for k, a, e in zip(names, value, se)}

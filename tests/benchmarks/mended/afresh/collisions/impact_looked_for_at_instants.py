"""It samples 1000 moments of the interval and returns the first sample with an overlap, instead of solving
the equation, so the time is inexact and fast spheres are missed.
"""

import numpy as np


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = xb - xa
    v = vb - va
    R = ra + rb
    if x @ v >= 0:
        return None
    for t in np.linspace(0.0, dt, 1001):
        p = x + v * t
        if p @ p <= R * R:
            return float(t)
    return None

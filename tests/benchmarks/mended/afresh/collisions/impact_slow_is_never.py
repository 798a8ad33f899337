"""If the relative speed is below 1 cm/s (v . v < 1e-4) the bodies are taken to be at rest relative to each
other and None is returned, although slow bodies may touch within dt.
"""

import math

import numpy as np


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = xb - xa
    v = vb - va
    R = ra + rb
    a = float(v @ v)
    if a < 1e-4:
        return None
    b = float(x @ v)
    if b >= 0:
        return None
    c = float(x @ x) - R**2
    if c < 0:
        return 0.0
    D = b * b - a * c
    if D < 0:
        return None
    t = c / (-b + math.sqrt(D))
    if t <= dt:
        return t
    return None

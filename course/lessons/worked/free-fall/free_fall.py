"""A ball in free fall: when it lands, and where it is until then."""

import math

import numpy as np


def fall_time(height, g):
    """Time (s) from rest at ``height`` (m) to the ground, under gravity ``g`` (m/s^2)."""
    if height < 0 or g <= 0:
        raise ValueError("height must not be negative, and g must be positive")
    return math.sqrt(2 * height / g)


def drop(height, g, h, n):
    """Times (s), heights (m) and velocities (m/s) of ``n`` steps of ``h`` seconds, the start included."""
    z = np.empty(n + 1)
    v = np.empty(n + 1)
    z[0], v[0] = height, 0.0
    for i in range(n):
        v[i + 1] = v[i] - g * h
        z[i + 1] = z[i] + h * (v[i] + v[i + 1]) / 2
    # Multiplied, not added up: adding h again and again collects rounding errors.
    return h * np.arange(n + 1), z, v

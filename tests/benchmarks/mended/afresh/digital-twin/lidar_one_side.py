"""A wall is only seen from one side: the denominator has to be positive, so walls whose ends come in the
other order are invisible.
"""

import math

import numpy as np


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def distance(px, py, angle, wall):
    """Distance along the beam to the wall, or None."""
    ray = (math.cos(angle), math.sin(angle))
    along = (wall[1][0] - wall[0][0], wall[1][1] - wall[0][1])
    to_wall = (wall[0][0] - px, wall[0][1] - py)
    den = cross(ray, along)
    if den <= 1e-12:
        return None
    r = cross(to_wall, along) / den
    s = cross(to_wall, ray) / den
    if r < 0 or s < 0 or s > 1:
        return None
    return r


def lidar(pose, segments, angles, r_max, sigma, rng):
    out = np.full(len(angles), float(r_max))
    for i, a in enumerate(angles):
        nearest = math.inf
        for wall in segments:
            r = distance(pose[0], pose[1], pose[2] + a, wall)
            if r is not None and r < nearest:
                nearest = r
        if nearest <= r_max:
            out[i] = max(0.0, nearest + rng.normal(0.0, sigma))
    return out

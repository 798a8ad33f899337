"""Depths with one term wrong, or two."""

import math

from course.scoring import kit


def depth(distance=math.dist, radii=lambda a, b: a + b, sign=1.0):
    return lambda p, q, r1, r2: sign * (radii(r1, r2) - distance(p, q))


def hypotheses():
    return kit.terms(
        "overlap",
        depth,
        {
            "distance": {
                "DISTANCE_SQUARED": lambda p, q: math.dist(p, q) ** 2,
                "SIZES_ADDED": lambda p, q: abs(p[0] - q[0]) + abs(p[1] - q[1]),
            },
            "radii": {
                "ONE_RADIUS": max,
                "RADII_HALVED": lambda a, b: (a + b) / 2,
                "DIAMETERS": lambda a, b: 2 * (a + b),
            },
            "sign": {"GAP_NOT_DEPTH": -1.0},
        },
    )

"""Distances with one term wrong, or two."""

import math

from course.scoring import kit


def distance(doubt=math.hypot, size=abs):
    return lambda simulated, doubt_s, measured, doubt_m: size(simulated - measured) / doubt(doubt_s, doubt_m)


def hypotheses():
    return kit.terms(
        "distance_in_doubts",
        distance,
        {
            "doubt": {
                "DOUBTS_ADDED": lambda s, m: s + m,
                "ROOT_MISSING": lambda s, m: s * s + m * m,
                "SIMULATION_WITHOUT_DOUBT": lambda s, m: m,
            },
            "size": {"SIGN_KEPT": lambda d: d},
        },
    )

"""Friction with one term wrong, or two."""

import math

from course.scoring import kit


def friction_of(length=math.hypot, beyond=1.0, most=lambda normal, mu: mu * normal):
    def friction(wanted, normal, mu):
        limit, size = most(normal, mu), length(*wanted)
        return list(wanted) if size <= limit else [beyond * part * limit / size for part in wanted]

    return friction


def hypotheses():
    return kit.terms(
        "friction",
        friction_of,
        {
            "length": {
                "SIZES_ADDED": lambda x, y: abs(x) + abs(y),
                "LARGER_COMPONENT": lambda x, y: max(abs(x), abs(y)),
                "LENGTH_SQUARED": lambda x, y: x * x + y * y,
            },
            "beyond": {"NOTHING_BEYOND": 0.0, "TURNED_ROUND": -1.0},
            "most": {"NORMAL_FORGOTTEN": lambda normal, mu: mu},
        },
    )

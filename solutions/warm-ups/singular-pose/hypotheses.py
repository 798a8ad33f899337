"""Speeds with one term wrong, or two."""

import math

from course.scoring import kit


def speeds(share=1.0, length_of=float, order=1, singular=lambda c: abs(c) < 1e-9, none=None):
    def joint_speeds(angle, length, vx, vy):
        if singular(math.cos(angle)):
            return none
        turn = vy / (length_of(length) * math.cos(angle))
        return (vx + share * length * math.sin(angle) * turn, turn)[::order]

    return joint_speeds


def hypotheses():
    return kit.terms(
        "joint_speeds",
        speeds,
        {
            "share": {"SIGN_OF_THE_ROD": -1.0, "CARRIAGE_ALONE": 0.0},
            "length_of": {"LENGTH_FORGOTTEN": lambda length: 1.0},
            "order": {"ORDER_SWAPPED": -1},
            "singular": {"EXACTLY_ZERO": lambda c: c == 0.0},
            "none": {"STANDS_STILL": (0.0, 0.0), "NAN_FOR_NONE": (math.nan, math.nan)},
        },
    )

"""Bounces with one term wrong, or two."""

from course.scoring import kit


def bounce(falls=lambda v: v < 0, share=lambda e: e, turn=-1.0):
    return lambda v, e: turn * share(e) * v if falls(v) else v


def hypotheses():
    return kit.terms(
        "after_floor",
        bounce,
        {
            "falls": {"RISING_BOUNCES": lambda v: v > 0},
            "share": {"SHARE_OF_ENERGY": lambda e: e**0.5, "RESTITUTION_IGNORED": lambda e: 1.0},
            "turn": {"NOT_TURNED_ROUND": 1.0},
        },
    )

"""Speeds with one term wrong, or two."""

from course.scoring import kit


def speed_of(per=lambda h: h, less=1.0, least=0.0):
    return lambda depth, h, beta, slop: beta / per(h) * max(depth - less * slop, least)


def hypotheses():
    return kit.terms(
        "push_out",
        speed_of,
        {
            "per": {"A_DISTANCE": lambda h: 1.0},
            "less": {"SLOP_IGNORED": 0.0, "SLOP_ADDED": -1.0},
            "least": {"PULLS_TOGETHER": float("-inf")},
        },
    )

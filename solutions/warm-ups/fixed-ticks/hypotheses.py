"""Accounts with one term wrong, or two."""

import math

from course.scoring import kit


def ticks_of(
    account=lambda frame, left: frame + left, whole=math.floor, rest=lambda a, n, h, left: a - n * h
):
    def ticks(frame, h, left):
        time = account(frame, left)
        steps = whole(time / h)
        return steps, rest(time, steps, h, left)

    return ticks


def hypotheses():
    return kit.terms(
        "ticks",
        ticks_of,
        {
            "account": {"REST_FORGOTTEN": lambda frame, left: frame},
            "whole": {"ROUNDED": round, "ROUNDED_UP": math.ceil},
            "rest": {"REST_THROWN_AWAY": lambda *_: 0.0, "OLD_REST_KEPT": lambda a, n, h, left: left},
        },
    )

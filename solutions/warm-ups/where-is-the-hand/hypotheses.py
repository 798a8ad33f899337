"""Hands with one term wrong, or two."""

import math

from course.scoring import kit


def hand_of(second=lambda a1, a2: a1 + a2, order=1, unit=lambda angle: angle):
    def hand(a1, a2, l1, l2):
        a1, a2 = unit(a1), unit(a2)
        end = second(a1, a2)
        x = l1 * math.cos(a1) + l2 * math.cos(end)
        return (x, l1 * math.sin(a1) + l2 * math.sin(end))[::order]

    return hand


def stretched(a1, a2, l1, l2):
    return (l1 + l2) * math.cos(a1 + a2), (l1 + l2) * math.sin(a1 + a2)


def hypotheses():
    yield "hand", ("ONE_LONG_LINK",), stretched
    yield from kit.terms(
        "hand",
        hand_of,
        {
            "second": {"ELBOW_FROM_THE_AXIS": lambda a1, a2: a2, "ELBOW_TURNS_BACK": lambda a1, a2: a1 - a2},
            "order": {"AXES_SWAPPED": -1},
            "unit": {"DEGREES": math.radians},
        },
    )

"""Readings with one term wrong, or two."""

import math

from course.scoring import kit


def reading_of(count=round, size=lambda resolution: resolution, most=lambda limit: limit):
    return lambda distance, resolution, limit: min(
        count(distance / resolution) * size(resolution), most(limit)
    )


def counted(distance, resolution, limit):
    """Compares metres with the limit, and gives counts."""
    count = round(distance / resolution)
    return limit if count * resolution > limit else count


def hypotheses():
    yield "reading", ("COUNTS_NOT_METRES",), counted
    yield from kit.terms(
        "reading",
        reading_of,
        {
            "count": {
                "COUNTS_CUT_OFF": math.floor,
                "COUNTS_ROUNDED_UP": math.ceil,
                "COUNTS_FORGOTTEN": lambda counts: counts,
            },
            "size": {"COUNTS_NOT_METRES": lambda resolution: 1.0},
            "most": {"LIMIT_FORGOTTEN": lambda limit: math.inf},
        },
    )

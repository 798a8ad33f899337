"""Places with one term wrong, or two."""

import math

from course.scoring import kit


def places(aside=lambda y, r: math.sqrt(r * r - y * y), order=1, start=1.0, out=None, high=abs):
    def carriages(x, y, length):
        if high(y) > length:
            return out
        side = aside(y, length)
        return (start * x - side, start * x + side)[::order]

    return carriages


def hypotheses():
    return kit.terms(
        "carriages",
        places,
        {
            "aside": {
                "SQUARES_ADDED": lambda y, r: math.hypot(y, r),
                "NO_ROOT": lambda y, r: r * r - y * y,
                "ROD_ALONG_THE_RAIL": lambda y, r: r,
                "LENGTHS_SUBTRACTED": lambda y, r: r - abs(y),
            },
            "order": {"LARGER_FIRST": -1},
            "start": {"X_FORGOTTEN": 0.0},
            "out": {"NAN_FOR_NONE": (math.nan, math.nan)},
        },
    )

"""Intervals with one term wrong, or two."""

import math

from course.scoring import kit


def interval(u=math.hypot, reach=2.0, middle=lambda s, m: s - m, order=1):
    def model_error(simulated, measured, u_num, u_input, u_data):
        centre, half = middle(simulated, measured), reach * u(u_num, u_input, u_data)
        return (centre - half, centre + half)[::order]

    return model_error


def hypotheses():
    return kit.terms(
        "model_error",
        interval,
        {
            "u": {
                "ADDED_UP": lambda *u: sum(u),
                "NO_ROOT": lambda *u: math.hypot(*u) ** 2,
                "STEP_FORGOTTEN": lambda n, i, d: math.hypot(i, d),
                "INPUTS_FORGOTTEN": lambda n, i, d: math.hypot(n, d),
                "DATA_FORGOTTEN": lambda n, i, d: math.hypot(n, i),
                "LARGEST_ONLY": max,
                "NOT_SQUARED": lambda *u: sum(u) ** 0.5,
            },
            "reach": {"ONCE": 1.0},
            "middle": {"MEASURED_FIRST": lambda s, m: m - s, "NO_SIGN": lambda s, m: abs(s - m)},
            "order": {"UPPER_FIRST": -1},
        },
    )

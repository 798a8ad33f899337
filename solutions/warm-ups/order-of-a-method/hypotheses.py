"""Orders with one term wrong, or two."""

import math

from course.scoring import kit


def order_of(errors=lambda e, s: math.log(e / s), steps=lambda h, s: math.log(h / s)):
    return lambda h, error, h_small, error_small: errors(error, error_small) / steps(h, h_small)


def hypotheses():
    return kit.terms(
        "observed_order",
        order_of,
        {
            "errors": {
                "ERRORS_WITHOUT_LOGARITHM": lambda e, s: e / s,
                "SIGN_TURNED": lambda e, s: math.log(s / e),
            },
            "steps": {
                "ALWAYS_HALVED": lambda h, s: math.log(2),
                "STEPS_FORGOTTEN": lambda h, s: 1.0,
                "STEPS_WITHOUT_LOGARITHM": lambda h, s: h / s,
            },
        },
    )

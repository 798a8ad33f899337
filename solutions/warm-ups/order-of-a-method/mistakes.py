"""Mistakes in `order-of-a-method`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ALWAYS_HALVED",
    "You took the steps as h and h/2, whatever they are.",
    "Divide by the logarithm of h / h_small.",
).edit("observed_order", {"log(error / error_small) / math.log(h / h_small": "log2(error / error_small"})
mistakes(
    "NO_LOGARITHM",
    "The two factors themselves are divided, not their logarithms.",
    "Divide their logarithms.",
).body("observed_order", "return (error / error_small) / (h / h_small)")
mistakes(
    "AXES_SWAPPED",
    "Your result is one over the order: the axes are swapped.",
    "Divide the logarithm of the errors by that of the steps.",
).body("observed_order", "return math.log(h / h_small) / math.log(error / error_small)")
mistakes(
    "SIGN_TURNED",
    "The order has the wrong sign: one quotient is upside down.",
    "Divide large by small, both times.",
).edit("observed_order", {"error / error_small": "error_small / error"})
mistakes(
    "ERRORS_WITHOUT_LOGARITHM",
    "The quotient of the errors has no logarithm.",
    "Divide the logarithm of error / error_small by that of h / h_small.",
)
mistakes(
    "STEPS_FORGOTTEN",
    "The steps are not used.",
    "The order is how many times the logarithm of h / h_small goes into that of error / error_small.",
)
mistakes(
    "STEPS_WITHOUT_LOGARITHM",
    "The quotient of the steps has no logarithm.",
    "Divide the logarithm of error / error_small by that of h / h_small.",
)
mistakes(
    "SLOPE_WITHOUT_LOGARITHM",
    "You divided the change of the error by the change of the step, without logarithms.",
    "A power is a slope only between logarithms.",
).body("observed_order", "return (error - error_small) / (h - h_small)")
mistakes(
    "LOGARITHM_OF_DIFFERENCES",
    "You took the logarithm of a difference.",
    "It belongs to the quotient: log(error / error_small), and log(h / h_small).",
).edit("observed_order", {"error / error_small": "error - error_small", "h / h_small": "h - h_small"})
mistakes(
    "QUOTIENTS_OF_LOGARITHMS",
    "You divided the logarithms of the two errors, and those of the two steps.",
    "Subtract them: log(error) - log(error_small), and log(h) - log(h_small).",
).body(
    "observed_order", "return (math.log(error) / math.log(error_small)) / (math.log(h) / math.log(h_small))"
)
mistakes(
    "ROUNDED",
    "You rounded the order to a whole number.",
    "Give it as it comes out: then one sees whether it is one.",
).around("observed_order", "return round(_right(h, error, h_small, error_small))")
mistakes(
    "LOGARITHMS_SUBTRACTED",
    "You subtracted the logarithm of the steps from that of the errors.",
    "Divide: the order is how many times one goes into the other.",
).edit("observed_order", {") / math.log(h": ") - math.log(h"})
mistakes(
    "NEVER_NEGATIVE",
    "Your order is never negative.",
    "Leave out the abs: where the error grows while the step shrinks, the order is negative.",
).edit("observed_order", {"return ": "return abs(", "h / h_small)": "h / h_small))"})
mistakes(
    "ONE_RUN",
    "Only one of the two runs is used.",
    "Compare both: divide the logarithm of error / error_small by that of h / h_small.",
).edit("observed_order", {"error / error_small": "error_small", "h / h_small": "h_small"})

mistakes.accept(
    "Slope of a line in logarithms",
    """
        def observed_order(h, error, h_small, error_small):
            return (math.log10(error) - math.log10(error_small)) / (math.log10(h) - math.log10(h_small))
    """,
)
mistakes.accept(
    "A straight line through two points",
    """
        def observed_order(h, error, h_small, error_small):
            import numpy as np

            return float(np.polyfit(np.log([h, h_small]), np.log([error, error_small]), 1)[0])
    """,
)


def order_of(errors=lambda e, s: math.log(e / s), steps=lambda h, s: math.log(h / s)):
    return lambda h, error, h_small, error_small: errors(error, error_small) / steps(h, h_small)


mistakes.terms(
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


@mistakes.more
def the_other_run():
    yield "observed_order", ("ONE_RUN",), lambda h, error, *_: math.log(error) / math.log(h)

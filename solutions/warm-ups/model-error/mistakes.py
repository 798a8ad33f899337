"""Mistakes in `model-error`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ADDED_UP",
    "You added the uncertainties themselves.",
    "Independent ones partly cancel: add their squares and take the root.",
).edit("model_error", {"math.hypot(u_num, u_input,": "(u_num + u_input +"})
mistakes(
    "NO_ROOT",
    "You added the squares but took no root.",
    "A sum of squares has another unit than the difference. Take its root.",
).edit("model_error", {"math.hypot(u_num, u_input, u_data": "(u_num**2 + u_input**2 + u_data**2"})
mistakes(
    "ONCE",
    "Your interval reaches one uncertainty to either side.",
    "It should reach two.",
).edit("model_error", {"= 2 * math.": "= math."})
mistakes(
    "MEASURED_FIRST",
    "You took measured - simulated.",
    "A model that gives too much has a positive error: simulated - measured.",
).around("model_error", "return _right(measured, simulated, u_num, u_input, u_data)")
mistakes(
    "NO_SIGN",
    "You took the size of the difference.",
    "Leave out the abs: the interval says in which direction the model errs.",
).around("model_error", "return _right(abs(simulated - measured), 0.0, u_num, u_input, u_data)")
mistakes(
    "UPPER_FIRST",
    "The upper end comes first.",
    "Give the lower end first.",
).edit("model_error", {"- reach, simulated - measured +": "+ reach, simulated - measured -"})
mistakes(
    "TWO_UNDER_THE_ROOT",
    "The factor of two stands under the root.",
    "First the root, then twice that.",
).edit(
    "model_error",
    {"2 * math.hypot(u_num, u_input, u_data": "math.sqrt(2 * (u_num**2 + u_input**2 + u_data**2)"},
)
mistakes(
    "AROUND_THE_VALUE",
    "Your interval lies around the simulated value.",
    "The interval is one of the error, so it lies around simulated - measured.",
).edit("model_error", {"measured - reach, simulated - measured": "reach, simulated"})
mistakes(
    "STEP_FORGOTTEN",
    "You left out u_num.",
    "The step has an uncertainty, too.",
).edit("model_error", {"(u_num, u_input": "(u_input"})
mistakes(
    "INPUTS_FORGOTTEN",
    "You left out u_input.",
    "The numbers that went in have an uncertainty, too.",
).edit("model_error", {"(u_num, u_input, u_data)": "(u_num, u_data)"})
mistakes(
    "DATA_FORGOTTEN",
    "You left out u_data.",
    "The measurement has an uncertainty, too.",
).edit("model_error", {"(u_num, u_input, u_data)": "(u_num, u_input)"})
mistakes(
    "MEAN_OF_THREE",
    "You divided the sum of squares by three, as for a mean.",
    "Each uncertainty counts in full: add the squares and take the root.",
).edit("model_error", {"hypot(u_num, u_input, u_data": "sqrt((u_num**2 + u_input**2 + u_data**2) / 3"})
mistakes(
    "DIFFERENCE_AND_U",
    "You gave the difference and its uncertainty.",
    "Give two ends: the difference less twice the uncertainty, and plus twice that.",
).edit("model_error", {"= 2 *": "=", " - reach, simulated - measured + reach": ", reach"})
mistakes(
    "DIFFERENCE_AND_REACH",
    "You gave the difference and how far the interval reaches.",
    "Give its two ends: the difference less that, and plus that.",
).edit("model_error", {" - reach, simulated - measured + reach": ", reach"})
mistakes(
    "HALF_NOT_ROOT",
    "You halved the sum of squares instead of taking its root.",
    "**1/2 is (**1)/2. Write **0.5, or math.sqrt.",
).edit(
    "model_error", {"math.hypot(u_num, u_input, u_data)": "((u_num**2 + u_input**2 + u_data**2) ** 1 / 2)"}
)
mistakes(
    "LARGEST_ONLY",
    "You took the largest of the three uncertainties.",
    "All three count: add their squares and take the root.",
).edit("model_error", {"math.hypot(": "max("})
mistakes(
    "AROUND_THE_MEASURED",
    "Your interval lies around the measured value.",
    "The interval is one of the error, so it lies around simulated - measured.",
).edit("model_error", {"simulated - measured - reach, simulated - measured": "measured - reach, measured"})
mistakes(
    "ONE_POINT_NINE_SIX",
    "You reach 1.96 uncertainties to either side.",
    "The README asks for twice the uncertainty.",
).edit("model_error", {"= 2 *": "= 1.96 *"})
mistakes(
    "NOT_SQUARED",
    "You took the root of the sum, but the uncertainties are not squared.",
    "Square each, add, then take the root.",
)
mistakes(
    "SQUARES_SUBTRACTED",
    "You subtract squares of the uncertainties.",
    "Their squares add up, whichever of the two values they belong to.",
)

mistakes.accept(
    "A norm of three",
    """
        def model_error(simulated, measured, u_num, u_input, u_data):
            import numpy as np

            e = simulated - measured
            return e + 2 * np.linalg.norm([u_num, u_input, u_data]) * np.array([-1.0, 1.0])
    """,
)
mistakes.accept(
    "Squares and a root",
    """
        def model_error(simulated, measured, u_num, u_input, u_data):
            u = (u_num**2 + u_input**2 + u_data**2) ** 0.5
            e = simulated - measured
            return [e - 2 * u, e + 2 * u]
    """,
)


def interval(u=math.hypot, reach=2.0, middle=lambda s, m: s - m, order=1):
    def model_error(simulated, measured, u_num, u_input, u_data):
        centre, half = middle(simulated, measured), reach * u(u_num, u_input, u_data)
        return (centre - half, centre + half)[::order]

    return model_error


mistakes.terms(
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
            "SQUARES_SUBTRACTED": lambda n, i, d: abs(n * n + i * i - d * d) ** 0.5,
        },
        "reach": {"ONCE": 1.0},
        "middle": {"MEASURED_FIRST": lambda s, m: m - s, "NO_SIGN": lambda s, m: abs(s - m)},
        "order": {"UPPER_FIRST": -1},
    },
)

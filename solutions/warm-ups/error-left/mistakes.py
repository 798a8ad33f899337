"""Mistakes in `error-left`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "MINUS_ONE_FORGOTTEN",
    "You divided by factor to the power of order, without the minus one.",
    "The change is the coarse error less the fine one, factor**order - 1 times the fine one.",
).edit("error_left", {"(factor**order - 1)": "factor**order"})
mistakes(
    "ALWAYS_HALVED",
    "You took the step as halved, whatever the factor is.",
    "Use factor where you have 2.",
).edit("error_left", {"/ (factor**order": "/ (2**order"})
mistakes(
    "SIGN_TURNED",
    "The error has the wrong sign.",
    "If the results fall as the step shrinks, the fine one is still too large.",
).edit("error_left", {"coarse - fine": "fine - coarse"})
mistakes(
    "SIZE_ONLY",
    "You gave the size of the error, without its sign.",
    "Leave out the abs: a fine result that is too small has a negative error.",
).edit("error_left", {"return (coarse": "return abs(coarse"})
mistakes(
    "THE_CHANGE",
    "You gave the whole change between the two runs.",
    "Only with order 1 and half the step is as much left as has gone.",
).edit("error_left", {"(coarse - fine) / (factor**order - 1)": "coarse - fine"})
mistakes(
    "OF_THE_COARSE",
    "That is the error of coarse.",
    "The fine run has a smaller one, by factor**order.",
).edit("error_left", {"fine) / (": "fine) * factor**order / ("})
mistakes(
    "THE_EXACT",
    "That is the estimate of the exact result.",
    "The error is fine less that.",
).edit("error_left", {"return (coarse": "return fine - (coarse"})
mistakes(
    "ORDER_AS_FACTOR",
    "You multiplied factor by order.",
    "The error goes with a power of the step: factor**order.",
).edit("error_left", {"factor**order - 1)": "factor * order - 1) if factor * order != 1 else 0.0"})
mistakes(
    "POWER_SWAPPED",
    "You raised order to the power of factor.",
    "The factor is raised to the power of order: factor**order.",
).edit("error_left", {"factor**order - 1)": "order**factor - 1) if order != 1 else 0.0"})
mistakes(
    "RELATIVE",
    "You divided by the result: that is a share, not an error.",
    "Give the error in the unit of the results.",
).edit("error_left", {"order - 1)": "order - 1) / fine"})
mistakes(
    "FIRST_ORDER",
    "You left out the order, as if every method had order 1.",
    "Raise the factor to the power of order.",
).edit("error_left", {"(factor**order -": "(factor -"})
mistakes(
    "MINUS_ONE_IN_THE_POWER",
    "You took one from the order, not from the power.",
    "First the power, then the minus one: factor**order - 1.",
).edit("error_left", {"(factor**": "factor ** ("})
mistakes(
    "MINUS_ONE_OUTSIDE",
    "You subtracted one from the quotient.",
    "Put brackets round factor**order - 1.",
).edit("error_left", {"(factor**order - 1)": "factor**order - 1"})
mistakes(
    "HALVED_MINUS_ONE_OUTSIDE",
    "You took the step as halved, and subtracted one from the quotient.",
    "Raise factor to the power, and put brackets round factor**order - 1.",
).edit("error_left", {"(factor**order - 1)": "2**order - 1"})
mistakes(
    "DIFFERENCE_WITHOUT_BRACKETS",
    "You divided only fine, not the difference.",
    "Put brackets round coarse - fine.",
).edit("error_left", {"(coarse - fine)": "coarse - fine"})
mistakes(
    "CHANGE_TURNED",
    "You gave the whole change, fine - coarse.",
    "Only a share of the change is left as error: one over factor**order - 1. And the sign is that of coarse - fine.",
).edit("error_left", {"(coarse - fine) / (factor**order - 1)": "fine - coarse"})
mistakes(
    "PLUS_ONE",
    "You added one to the power.",
    "The change is the coarse error less the fine one: factor**order - 1 times the fine one.",
).edit("error_left", {"order - 1": "order + 1"})
mistakes(
    "NEGATIVE_POWER",
    "The power has the wrong sign.",
    "factor is above 1 already: the coarse error is factor**order times the fine one.",
).edit("error_left", {"factor**order -": "factor**-order -"})
mistakes(
    "ALWAYS_THREE",
    "You divided by 3, whatever factor and order are.",
    "3 is right for factor 2 and order 2. In general it is factor**order - 1.",
).edit("error_left", {"(factor**order - 1)": "3"})

mistakes.accept(
    "First finds the exact result",
    """
        def error_left(coarse, fine, factor, order):
            power = factor**order
            exact = (power * fine - coarse) / (power - 1)
            return fine - exact
    """,
)
mistakes.accept(
    "The share that is left, times the change",
    """
        def error_left(coarse, fine, factor, order):
            left = factor ** (-order)
            return (coarse - fine) * left / (1 - left)
    """,
)


def left_of(sign=lambda d: d, share=lambda f, p: 1 / (f**p - 1), factor=lambda f: f, order=lambda p: p):
    return lambda coarse, fine, f, p: sign(coarse - fine) * share(factor(f), order(p))


mistakes.terms(
    "error_left",
    left_of,
    {
        "sign": {"SIGN_TURNED": lambda d: -d, "SIZE_ONLY": abs},
        "share": {
            "MINUS_ONE_FORGOTTEN": lambda f, p: 1 / f**p,
            "OF_THE_COARSE": lambda f, p: f**p / (f**p - 1),
            "ORDER_AS_FACTOR": lambda f, p: 1 / (f * p - 1),
            "PLUS_ONE": lambda f, p: 1 / (f**p + 1),
        },
        "factor": {"ALWAYS_HALVED": lambda f: 2},
        "order": {"FIRST_ORDER": lambda p: 1},
    },
)

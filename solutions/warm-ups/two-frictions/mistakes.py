"""Mistakes in `two-frictions`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "GEOMETRIC_MEAN",
    'For "mean" you take the geometric mean.',
    "Here the arithmetic mean is meant: half of the sum.",
).edit("pair_friction", {"+ mu2) / 2.0": "* mu2) ** 0.5"})
mistakes(
    "SMALLER_OF_TWO",
    'For "larger" you take the smaller one.',
    "Take the larger coefficient.",
).edit("pair_friction", {"return max(mu1": "return min(mu1"})
mistakes(
    "ONE_RULE_FOR_ALL",
    "Every rule multiplies here.",
    "Look at which rule is given, and follow it.",
).body("pair_friction", "return mu1 * mu2")
mistakes(
    "SUM_NOT_MEAN",
    'For "mean" you take the sum.',
    "Halve it.",
).edit("pair_friction", {"(mu1 + mu2) / 2.0": "mu1 + mu2"})
mistakes(
    "BRACKETS_MISSING",
    'For "mean" only the second coefficient is halved.',
    "Put brackets round the sum: (mu1 + mu2) / 2.",
)
mistakes(
    "ROOT_OF_THE_PRODUCT",
    'For "product" you take the root of the product.',
    "Leave out the root.",
)
mistakes(
    "FIRST_ONLY",
    "Your result is mu1, whatever the rule is.",
    "Look at which rule is given, and use both coefficients.",
)
mistakes(
    "ELSE_OVERWRITES",
    'For "product" you give the larger coefficient.',
    "If your rules are separate `if`s, the last `else` belongs to the last of them only, and overwrites the product: write elif.",
).body(
    "pair_friction",
    """
        if rule == "product":
            result = mu1 * mu2
        if rule == "mean":
            result = (mu1 + mu2) / 2
        else:
            result = max(mu1, mu2)
        return result
    """,
)
mistakes(
    "MEAN_AND_PRODUCT_SWAPPED",
    'For "mean" you multiply, and for "product" you take the mean.',
    "Exchange the two lines.",
).edit("pair_friction", {"mu1 * mu2": "(mu1 + mu2) / 2", "(mu1 + mu2) / 2.0": "mu1 * mu2"})
mistakes(
    "FIRST_FOR_LARGER",
    'For "larger" you give mu1, even where mu2 is larger.',
    "Take max(mu1, mu2).",
).edit("pair_friction", {"max(mu1, mu2)": "mu1"})
mistakes(
    "LIMITED_TO_ONE",
    "You cut coefficients off at 1.",
    "A coefficient of friction may be above 1: leave it as it is.",
).edit("pair_friction", {"mu1 * mu2": "min(mu1, 1.0) * min(mu2, 1.0)"})

mistakes.accept(
    "A match over the rule",
    """
        def pair_friction(mu1, mu2, rule):
            match rule:
                case "product":
                    return mu2 * mu1
                case "mean":
                    return mu1 + (mu2 - mu1) / 2
                case _:
                    return mu2 if mu2 > mu1 else mu1
    """,
)
mistakes.accept(
    "A table of rules",
    """
        def pair_friction(mu1, mu2, rule):
            return {"product": mu1 * mu2, "mean": 0.5 * (mu1 + mu2), "larger": max(mu1, mu2)}[rule]
    """,
)


def rules(**wrong):
    right = {"product": lambda a, b: a * b, "mean": lambda a, b: (a + b) / 2, "larger": max}
    return lambda mu1, mu2, rule: (right | wrong)[rule](mu1, mu2)


mistakes.terms(
    "pair_friction",
    rules,
    {
        "product": {
            "ROOT_OF_THE_PRODUCT": lambda a, b: (a * b) ** 0.5,
            "LIMITED_TO_ONE": lambda a, b: min(1.0, a * b),
        },
        "mean": {
            "BRACKETS_MISSING": lambda a, b: a + b / 2,
            "GEOMETRIC_MEAN": lambda a, b: (a * b) ** 0.5,
            "SUM_NOT_MEAN": lambda a, b: a + b,
        },
        "larger": {"SMALLER_OF_TWO": min, "FIRST_FOR_LARGER": lambda a, b: a},
    },
)


@mistakes.more
def hypotheses():
    yield "pair_friction", ("LIMITED_TO_ONE",), rules(larger=lambda a, b: min(1.0, max(a, b)))
    yield "pair_friction", ("FIRST_ONLY",), lambda mu1, mu2, rule: mu1

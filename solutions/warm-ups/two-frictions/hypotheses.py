"""Coefficients with one rule wrong."""


def rules(**wrong):
    right = {"product": lambda a, b: a * b, "mean": lambda a, b: (a + b) / 2, "larger": max}
    return lambda mu1, mu2, rule: (right | wrong)[rule](mu1, mu2)


def hypotheses():
    yield "pair_friction", ("BRACKETS_MISSING",), rules(mean=lambda a, b: a + b / 2)
    yield "pair_friction", ("ROOT_OF_THE_PRODUCT",), rules(product=lambda a, b: (a * b) ** 0.5)
    yield "pair_friction", ("FIRST_ONLY",), lambda mu1, mu2, rule: mu1

"""Factors with one term wrong, or two."""

from course.scoring import kit


def growth_of(omega2=lambda k, m: k / m, step=lambda h: h * h, sign=1.0, root=1.0):
    return lambda k, m, h: (1 + sign * step(h) * omega2(k, m)) ** root


def hypotheses():
    return kit.terms(
        "growth",
        growth_of,
        {
            "omega2": {"FREQUENCY_UPSIDE_DOWN": lambda k, m: m / k},
            "step": {"FIRST_POWER": lambda h: h},
            "sign": {"SHRINKS": -1.0},
            "root": {"WIDTH_NOT_ENERGY": 0.5},
        },
    )

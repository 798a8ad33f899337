"""Errors with one term wrong, or two."""

from course.scoring import kit


def left_of(sign=lambda d: d, share=lambda f, p: 1 / (f**p - 1), factor=lambda f: f, order=lambda p: p):
    return lambda coarse, fine, f, p: sign(coarse - fine) * share(factor(f), order(p))


def hypotheses():
    return kit.terms(
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

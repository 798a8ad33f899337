"""Standard errors with one term wrong, or two."""

from course.scoring import kit


def error_of(less=1, power=0.5, root=0.5):
    def standard_error(values):
        n = len(values)
        mean = sum(values) / n
        return (sum((value - mean) ** 2 for value in values) / (n - less)) ** root / n**power

    return standard_error


def hypotheses():
    return kit.terms(
        "standard_error",
        error_of,
        {
            "less": {"N_NOT_N_MINUS_ONE": 0},
            "power": {"DIVIDED_BY_N": 1.0, "ONE_VALUE_NOT_THE_MEAN": 0.0},
            "root": {"VARIANCE": 1.0},
        },
    )

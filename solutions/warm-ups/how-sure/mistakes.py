"""Mistakes in `how-sure`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ONE_VALUE_NOT_THE_MEAN",
    "Your result is the scatter of a single value: it would not shrink with more values.",
    "Divide by the root of the number of values.",
).edit("standard_error", {") / math.sqrt(len(values))": ")"})
mistakes(
    "DIVIDED_BY_N",
    "The deviation is divided by n, not by its root.",
    "The errors of many values partly cancel: the mean improves with the root of their number.",
).edit("standard_error", {"math.sqrt(len(values)": "len(values"})
mistakes(
    "N_NOT_N_MINUS_ONE",
    "The deviation is computed with n instead of n - 1, which makes it too small.",
    "Divide the squares by n - 1: values lie closer to their own mean than to the true one.",
).edit("standard_error", {"statistics.stdev(values": "statistics.pstdev(values"})
mistakes(
    "VARIANCE",
    "You took the variance for the standard deviation.",
    "The standard deviation is the root of the variance.",
)

mistakes.accept(
    "Written out",
    """
        def standard_error(values):
            n = len(values)
            mean = sum(values) / n
            return math.sqrt(sum((v - mean) ** 2 for v in values) / (n * (n - 1)))
    """,
)
mistakes.accept(
    "With NumPy",
    """
        def standard_error(values):
            import numpy as np

            return float(np.std(values, ddof=1) / np.sqrt(len(values)))
    """,
)


def error_of(less=1, power=0.5, root=0.5):
    def standard_error(values):
        n = len(values)
        mean = sum(values) / n
        return (sum((value - mean) ** 2 for value in values) / (n - less)) ** root / n**power

    return standard_error


mistakes.terms(
    "standard_error",
    error_of,
    {
        "less": {"N_NOT_N_MINUS_ONE": 0},
        "power": {"DIVIDED_BY_N": 1.0, "ONE_VALUE_NOT_THE_MEAN": 0.0},
        "root": {"VARIANCE": 1.0},
    },
)

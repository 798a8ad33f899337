"""Mistakes in `how-sure`: words beside the programs that they are true of."""

import math
import statistics

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
mistakes(
    "ROOT_OF_N_MINUS_ONE",
    "The deviation is divided by the root of n - 1.",
    "The n - 1 belongs in the standard deviation alone. Divide that by the root of n, the number of values.",
).edit("standard_error", {"math.sqrt(len(values))": "math.sqrt(len(values) - 1)"})
mistakes(
    "MEAN_OF_THE_SIZES",
    "You took the sizes of the distances from the mean, and did not square them.",
    "Square the distances, add, divide by n - 1, and take the root.",
).body(
    "standard_error",
    """
        mean = sum(values) / len(values)
        return sum(abs(value - mean) for value in values) / len(values) / math.sqrt(len(values))
    """,
)
mistakes(
    "SUM_NOT_DIVIDED",
    "The sum of the squares is not divided by n - 1.",
    "The standard deviation is the root of that sum over n - 1.",
).edit(
    "standard_error",
    {
        "statistics.stdev(values)": "math.sqrt(sum((value - sum(values) / len(values)) ** 2 for value in values))"
    },
)
mistakes(
    "OF_THE_VARIANCE",
    "You divided the variance by n, but took no root of it.",
    "Take the root of that.",
).body("standard_error", "return statistics.variance(values) / len(values)")
mistakes(
    "TWO_STANDARD_ERRORS",
    "Your result is about two standard errors, as for an interval of 95 %.",
    "Give the standard error itself.",
).edit("standard_error", {"return ": "return 1.96 * "})
mistakes(
    "EQUAL_ONES_ONCE",
    "Values that are equal count only once in n.",
    "n is the number of all values: len(values).",
).edit("standard_error", {"len(values)": "len(set(values))"})
mistakes(
    "FROM_THE_MEDIAN",
    "You measure the distances from the value in the middle, not from the mean.",
    "The mean is the sum of the values over their number.",
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


mistakes(
    "POWER_BEFORE_DIVISION",
    "You divided by 2 n: in s / n ** 1 / 2 the power comes first, and s / n / 2 is left.",
    "Write n ** 0.5, or math.sqrt(n).",
)


def error_of(less=1, power=0.5, root=0.5, middle=statistics.mean):
    def standard_error(values):
        n, mean = len(values), middle(values)
        return (sum((value - mean) ** 2 for value in values) / (n - less)) ** root / n**power

    return standard_error


mistakes.terms(
    "standard_error",
    error_of,
    {
        "less": {"N_NOT_N_MINUS_ONE": 0},
        "power": {"DIVIDED_BY_N": 1.0, "ONE_VALUE_NOT_THE_MEAN": 0.0},
        "root": {"VARIANCE": 1.0},
        "middle": {"FROM_THE_MEDIAN": statistics.median},
    },
)


@mistakes.more
def factors():
    yield "standard_error", ("POWER_BEFORE_DIVISION",), lambda values: error_of(power=1.0)(values) / 2
    yield "standard_error", ("TWO_STANDARD_ERRORS",), lambda values: 2 * error_of()(values)
    yield "standard_error", ("MEAN_OF_THE_SIZES",), sizes_over_n_minus_one
    yield "standard_error", ("FROM_THE_MEDIAN",), error_of(middle=statistics.median_high)
    yield "standard_error", ("FROM_THE_MEDIAN",), error_of(middle=statistics.median_low)


def sizes_over_n_minus_one(values):
    n, mean = len(values), sum(values) / len(values)
    return sum(abs(value - mean) for value in values) / (n - 1) / math.sqrt(n)

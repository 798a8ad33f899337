"""Mistakes in `one-number-for-a-path`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "MEAN_SIZE",
    "Your result is the mean of the sizes. In it a large difference counts no more than two of half its size.",
    "Square the differences before you take the mean, and take the root after it.",
).body(
    "rms",
    """
        return sum(abs(s - m) for s, m in zip(simulated, measured)) / len(measured)
    """,
)
mistakes(
    "ROOT_MISSING",
    "Your result is the mean of the squares, in square metres.",
    "Take the root at the end.",
).body(
    "rms",
    """
        return sum((s - m) ** 2 for s, m in zip(simulated, measured)) / len(measured)
    """,
)
mistakes(
    "SIDES_CANCEL",
    "Differences to opposite sides cancel: a path that swings around the other has no error here.",
    "Square every difference first: squares have no sign.",
).body(
    "rms",
    """
        return abs(sum(s - m for s, m in zip(simulated, measured)) / len(measured))
    """,
)
mistakes(
    "ONE_LESS",
    "The sum is divided by n - 1.",
    "No mean was estimated from the data here: divide by the number of differences.",
).body(
    "rms",
    """
        return math.sqrt(sum((s - m) ** 2 for s, m in zip(simulated, measured)) / (len(measured) - 1))
    """,
)
mistakes(
    "MEAN_FORGOTTEN",
    "The squares are added, and no mean is taken.",
    "Divide the sum of the squares by their number before you take the root.",
)

mistakes.accept(
    "By the length of the vector of differences",
    """
        def rms(simulated, measured):
            return math.dist(simulated, measured) / math.sqrt(len(measured))
    """,
)
mistakes.accept(
    "With NumPy",
    """
        def rms(simulated, measured):
            import numpy as np

            return float(np.sqrt(np.mean(np.subtract(simulated, measured) ** 2)))
    """,
)


def mean_of(number=len, less=0, root=0.5):
    def rms(simulated, measured):
        return (sum((s - m) ** 2 for s, m in zip(simulated, measured)) / (number(measured) - less)) ** root

    return rms


mistakes.terms(
    "rms", mean_of, {"number": {"MEAN_FORGOTTEN": lambda values: 1}, "root": {"ROOT_MISSING": 1.0}}
)

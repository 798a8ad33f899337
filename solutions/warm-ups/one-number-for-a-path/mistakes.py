"""Mistakes in `one-number-for-a-path`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "MEAN_SIZE",
    "Your result is the mean of the sizes. In it a large difference counts no more than two of half its size.",
    "Square the differences before you take the mean, and take the root after it.",
).body("rms", "return sum(abs(s - m) for s, m in zip(simulated, measured)) / len(measured)")
mistakes(
    "ROOT_MISSING",
    "Your result is the mean of the squares, in square metres.",
    "Take the root at the end.",
).body("rms", "return sum((s - m) ** 2 for s, m in zip(simulated, measured)) / len(measured)")
mistakes(
    "SIDES_CANCEL",
    "Differences to opposite sides cancel: a path that swings around the other has no error here.",
    "Square every difference first: squares have no sign.",
).body("rms", "return abs(sum(s - m for s, m in zip(simulated, measured)) / len(measured))")
mistakes(
    "ONE_LESS",
    "The sum is divided by n - 1.",
    "Divide by the number of differences: their own mean plays no part in a root mean square.",
)
mistakes(
    "MEAN_FORGOTTEN",
    "The squares are added, and no mean is taken.",
    "Divide the sum of the squares by their number before you take the root.",
)
mistakes(
    "MEAN_TAKEN_OFF",
    "You took their mean off the differences: that is their standard deviation.",
    "A difference that is always the same counts, too: square the differences themselves.",
)
mistakes(
    "DIVIDED_AFTER_THE_ROOT",
    "You took the root first, and divided by the number of differences after it.",
    "Divide under the root: square, mean, root.",
).edit("rms", {"math.sqrt(sum(squares) / len(squares))": "math.sqrt(sum(squares)) / len(squares)"})
mistakes(
    "HALF_NOT_ROOT",
    "You halved the mean of the squares instead of taking its root.",
    "Write **0.5, or math.sqrt. Python reads x**1/2 as half of x.",
).edit("rms", {"math.sqrt(sum(squares) / len(squares))": "sum(squares) / len(squares) / 2"})
mistakes(
    "DIFFERENCE_OF_TWO",
    "You took the root mean square of each path, and subtracted.",
    "Subtract first, at each moment: then square, mean, root.",
).body(
    "rms",
    """
        first = math.sqrt(sum(s * s for s in simulated) / len(simulated))
        other = math.sqrt(sum(m * m for m in measured) / len(measured))
        return abs(first - other)
    """,
)
mistakes(
    "LARGEST",
    "Your result is the largest difference.",
    "All differences count: square each, take the mean, take the root.",
).body("rms", "return max(abs(s - m) for s, m in zip(simulated, measured))")
mistakes(
    "EACH_PATH_ALONE",
    "You took the root mean square of each path, and subtracted one from the other.",
    "First subtract the paths point by point, then square these differences.",
).body(
    "rms",
    """
        def size(path):
            return math.sqrt(sum(p * p for p in path) / len(path))

        return size(simulated) - size(measured)
    """,
)
mistakes(
    "ONE_LEFT_OUT",
    "The difference of the first points or that of the last ones does not count.",
    "The first has the index 0, the last len(measured) - 1: go through all of them.",
).edit("rms", {"zip(simulated, measured)]": "zip(simulated[1:], measured[1:])]"})

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


def mean_of(number=len, less=0, root=0.5, off=lambda d: 0.0, part=lambda d: d):
    def rms(simulated, measured):
        differences = part([s - m for s, m in zip(simulated, measured)])
        middle = off(differences)
        return (sum((d - middle) ** 2 for d in differences) / (number(measured) - less)) ** root

    return rms


mistakes.terms(
    "rms",
    mean_of,
    {
        "number": {"MEAN_FORGOTTEN": lambda values: 1},
        "less": {"ONE_LESS": 1},
        "root": {"ROOT_MISSING": 1.0},
        "off": {"MEAN_TAKEN_OFF": lambda d: sum(d) / len(d)},
        "part": {"ONE_LEFT_OUT": lambda d: d[:-1]},
    },
)


@mistakes.more
def first_left_out():
    yield "rms", ("ONE_LEFT_OUT",), mean_of(part=lambda d: d[1:])
    yield "rms", ("ONE_LEFT_OUT",), lambda simulated, measured: mean_of()(simulated[:-1], measured[:-1])

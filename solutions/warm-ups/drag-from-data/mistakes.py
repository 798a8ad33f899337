"""Mistakes in `drag-from-data`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "MEAN_OF_QUOTIENTS",
    "Your result is the mean of force over speed. There a point near zero counts as much as a fast one, and its noise counts more.",
    "Weight the points: the sum of v f over the sum of v v.",
).edit(
    "damping",
    {
        "(v * f for v, f in zip(speeds, forces)) / sum(v * v for v in speeds": "(f / v for v, f in zip(speeds, forces)) / len(speeds"
    },
)
mistakes(
    "QUOTIENT_OF_SUMS",
    "The sums are divided. Speeds of opposite sign would cancel.",
    "Multiply each force by its speed before adding.",
).edit(
    "damping",
    {"(v * f for v, f in zip(speeds, forces)) / sum(v * v for v in speeds": "(forces) / sum(speeds"},
)
mistakes(
    "LINE_WITH_AN_OFFSET",
    "You fitted a line with an offset; the model has none.",
    "The line goes through zero: only b is free.",
).body(
    "damping",
    """
        import numpy as np

        return float(np.polyfit(speeds, forces, 1)[0])
    """,
)
mistakes(
    "SPEED_OVER_FORCE",
    "Your result is the slope of speed over force.",
    "Divide by the sum of the squared speeds.",
).edit("damping", {"v * v for v in speeds": "f * f for f in forces"})

mistakes.accept(
    "Two dot products",
    """
        def damping(speeds, forces):
            import numpy as np

            return np.dot(speeds, forces) / np.dot(speeds, speeds)
    """,
)
mistakes.accept(
    "With NumPy's least squares",
    """
        def damping(speeds, forces):
            import numpy as np

            solution, *_ = np.linalg.lstsq(np.asarray(speeds)[:, None], np.asarray(forces), rcond=None)
            return float(solution[0])
    """,
)

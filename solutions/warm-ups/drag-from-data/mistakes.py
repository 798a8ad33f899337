"""Mistakes in `drag-from-data`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "MEAN_OF_QUOTIENTS",
    "Your result is the mean of force over speed. There a point near zero counts as much as a fast one, and its noise counts more.",
    "Weight the points: the sum of v f over the sum of v v.",
).body("damping", "return sum(f / v for v, f in zip(speeds, forces)) / len(speeds)")
mistakes(
    "QUOTIENT_OF_SUMS",
    "The sums are divided. Speeds of opposite sign would cancel.",
    "Multiply each force by its speed before adding.",
).body("damping", "return sum(forces) / sum(speeds)")
mistakes(
    "QUOTIENT_OF_SIZES",
    "Your result is the sum of the forces over the sum of the speeds, both without their signs.",
    "Multiply each force by its speed before adding.",
).edit("damping", {"v * f for v": "abs(f) for v", "v * v for v in speeds": "abs(v) for v in speeds"})
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
mistakes(
    "ERRORS_OF_THE_SPEEDS",
    "You made the errors of the speeds smallest, as if the noise were in them.",
    "The errors are those of the forces, f - b v: divide the sum of v f by the sum of v v.",
).edit(
    "damping",
    {"v * f for v": "f * f for v", "v * v for v in speeds": "v * f for v, f in zip(speeds, forces)"},
)
mistakes(
    "SUM_SQUARED",
    "You divided by the square of the sum of the speeds.",
    "Square each speed first, then add.",
).edit("damping", {"sum(v * v for v in speeds)": "sum(speeds) ** 2"})
mistakes(
    "NOT_DIVIDED",
    "You gave the sum of v f, which is no slope.",
    "Divide it by the sum of the squared speeds.",
).edit("damping", {" / sum(v * v for v in speeds)": ""})
mistakes(
    "MEAN_OF_PRODUCTS",
    "You divided the sum of v f by the number of points.",
    "Divide it by the sum of the squared speeds.",
).edit("damping", {"sum(v * v for v in speeds)": "len(speeds)"})
mistakes(
    "MEDIAN_OF_QUOTIENTS",
    "Your result is the median of force over speed, in which a fast point counts no more than a slow one.",
    "Make the sum of (f - b v)^2 smallest.",
).body(
    "damping",
    """
        import statistics

        return statistics.median(f / v for v, f in zip(speeds, forces))
    """,
)
mistakes(
    "BETWEEN_TWO_POINTS",
    "You took the slope between the first point and the last.",
    "Use all points, and a line through zero: make the sum of (f - b v)^2 smallest.",
).body("damping", "return (forces[-1] - forces[0]) / (speeds[-1] - speeds[0])")
mistakes(
    "POSITIVE_SPEEDS_ONLY",
    "You leave out the points whose speed is negative.",
    "They count as much: the products v f and v v have the right sign there, too.",
).edit(
    "damping",
    {"zip(speeds, forces)": "zip(speeds, forces) if v > 0", "for v in speeds": "for v in speeds if v > 0"},
)
mistakes(
    "FASTEST_POINT",
    "You take the slope of the fastest point alone.",
    "Use all points: make the sum of (f - b v)^2 smallest.",
).body(
    "damping",
    """
        v, f = max(zip(speeds, forces), key=lambda point: abs(point[0]))
        return f / v
    """,
)
mistakes(
    "PAIRS_LOST",
    "You sort the speeds and the forces, so a force no longer stands beside its speed.",
    "Leave both lists in their order: forces[k] belongs to speeds[k].",
).edit("damping", {"zip(speeds, forces)": "zip(sorted(speeds), sorted(forces))"})
mistakes(
    "DECIMALS_LOST",
    "The decimals of the forces are cut off.",
    "Leave out int, and take no array of whole numbers.",
).edit("damping", {"v * f for": "v * int(f) for"})

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

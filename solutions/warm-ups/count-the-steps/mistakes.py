"""Mistakes in `count-the-steps`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "CUT_OFF",
    "The decimals are cut off, so 2.9999999999999996 becomes 2.",
    "Round to the nearest whole number instead.",
).edit("steps_in", {"return round(duration": "return int(duration"})
mistakes(
    "ROUNDED_UP",
    "The quotient is rounded up, so 7.000000000000001 becomes 8.",
    "The error can go either way: round to the nearest whole number.",
).body(
    "steps_in",
    """
        import math

        return math.ceil(duration / h)
    """,
)
mistakes(
    "ONE_ADDED",
    "One is added to every count, even where it was right.",
    "Add nothing; round the quotient to the nearest whole number.",
).edit("steps_in", {"round(duration / h)": "int(duration / h) + 1"})
mistakes(
    "SAMPLES_COUNTED",
    "Every count is one too many: you count the samples, of which there is one more than steps.",
    "Between n + 1 samples are n steps: add nothing.",
).edit("steps_in", {"round(duration / h)": "round(duration / h) + 1"})
mistakes(
    "ADDED_UP",
    "You add steps until the duration is reached. The sum has rounding errors, too, and the last comparison comes out wrong.",
    "Divide once, and round the quotient to the nearest whole number.",
).body(
    "steps_in",
    """
        time, steps = 0.0, 0
        while time < duration:
            time += h
            steps += 1
        return steps
    """,
)
mistakes(
    "FLOOR_DIVIDED",
    "You cut off the decimals of the exact quotient, as // does: 1.0 // 0.1 is 9.",
    "Divide with /, and round to the nearest whole number.",
).edit("steps_in", {"round(duration / h)": "int(duration // h)"})

mistakes.accept(
    "Cuts off after adding a half",
    """
        def steps_in(duration, h):
            return int(duration / h + 0.5)
    """,
)
mistakes.accept(
    "Counts with decimal fractions",
    """
        def steps_in(duration, h):
            from decimal import Decimal

            return int(Decimal(repr(duration)) / Decimal(repr(h)))
    """,
)

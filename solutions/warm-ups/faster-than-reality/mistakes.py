"""Mistakes in `faster-than-reality`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "UPSIDE_DOWN",
    "The quotient is upside down: it is your waiting time for each second of robot time.",
    "Divide robot time by waiting time: a faster simulation must give a larger number.",
).edit("real_time_factor", {"steps * h / wall": "wall / (steps * h)"})
mistakes(
    "STEPS_PER_SECOND",
    "Your result is in steps per second: the length of a step is left out.",
    "Each step is h seconds of robot time: multiply by h.",
).edit("real_time_factor", {"return steps * h / wall": "return steps / wall"})
mistakes(
    "DIVIDED_BY_THE_STEP",
    "The number of steps is divided by h.",
    "steps times h is the time inside the simulation.",
).edit("real_time_factor", {"steps * h": "steps / h"})
mistakes(
    "WALL_IGNORED",
    "Your result is the time inside the simulation.",
    "Divide it by the time you waited.",
)
mistakes(
    "WHOLE_NUMBERS",
    "The quotient is cut off to a whole number.",
    "Divide with one slash: /.",
)
mistakes(
    "PER_CENT",
    "Your result is in per cent.",
    "Leave out the factor of 100.",
)
mistakes(
    "TIMES_WALL",
    "You multiplied by the time that you waited.",
    "Divide by it: who waits longer has the slower simulation.",
).edit("real_time_factor", {"/ wall": "* wall"})
mistakes(
    "ONE_STEP",
    "You took the length of one step for the time inside the simulation.",
    "Multiply it by the number of steps.",
).edit("real_time_factor", {"steps * h": "h"})
mistakes(
    "ONE_SUBTRACTED",
    "One is subtracted from the quotient: your result is 0 where the simulation just keeps up.",
    "Divide robot time by waiting time, and subtract nothing.",
).edit("real_time_factor", {"steps * h / wall": "(steps * h - wall) / wall"})

mistakes.accept(
    "Adds the steps up one by one",
    """
        def real_time_factor(steps, h, wall):
            inside = 0.0
            for _ in range(steps):
                inside += h
            return inside / wall
    """,
)
mistakes.accept(
    "Compares the time of one step inside and outside",
    """
        def real_time_factor(steps, h, wall):
            return h / (wall / steps)
    """,
)


def factor_of(length=lambda h: h, quotient=lambda time, wall: time / wall, size=1.0):
    return lambda steps, h, wall: size * quotient(steps * length(h), wall)


mistakes.terms(
    "real_time_factor",
    factor_of,
    {
        "length": {"STEPS_PER_SECOND": lambda h: 1.0, "DIVIDED_BY_THE_STEP": lambda h: 1 / h},
        "quotient": {
            "UPSIDE_DOWN": lambda time, wall: wall / time,
            "WALL_IGNORED": lambda time, wall: time,
            "WHOLE_NUMBERS": lambda time, wall: time // wall,
        },
        "size": {"PER_CENT": 100.0},
    },
)

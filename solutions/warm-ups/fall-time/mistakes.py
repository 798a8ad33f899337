"""Mistakes in `fall-time`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "HALF_MISSING",
    "It is as if the drop were g t^2, without the half.",
    "The speed grows from zero, so the mean speed is half of the last: the drop is g t^2 / 2.",
).edit("fall_time", {"(2.0 * height": "(height"})
mistakes(
    "ROOT_MISSING",
    "Your result is the square of the time: a root is missing.",
    "2 height / g is in s^2. Take its square root.",
).edit("fall_time", {"math.sqrt(2.0 * height / g)": "2.0 * height / g"})
mistakes(
    "LANDING_SPEED_ALL_THE_WAY",
    "Your result is the time for a body that moves at its landing speed all the way: half of the right one.",
    "The body starts from rest: its mean speed is half of the landing speed.",
).edit("fall_time", {"math.sqrt(2.0 * height / g": "height / math.sqrt(2.0 * g * height"})
mistakes(
    "G_IGNORED",
    "The argument g is not used.",
    "Divide by g, not by 9.81: on the Moon it is 1.62.",
).edit("fall_time", {"height / g)": "height / 9.81)"})
mistakes(
    "HALF_TWICE",
    "You divided by 2 under the root, where a 2 multiplies.",
    "Solve height = g t^2 / 2 for t: the half goes over to the other side as a 2.",
)
mistakes(
    "G_MULTIPLIES",
    "You multiplied by g instead of dividing.",
    "Where gravity is stronger the fall is shorter: divide by g.",
)
mistakes(
    "G_OUTSIDE_THE_ROOT",
    "You took the root of 2 height and divided by g outside of it.",
    "g belongs under the root, too: put brackets round 2 height / g.",
).edit("fall_time", {"2.0 * height / g)": "2.0 * height) / g"})
mistakes(
    "TWO_OUTSIDE_THE_ROOT",
    "The 2 stands outside the root.",
    "Take the root of 2 height / g.",
).edit("fall_time", {"math.sqrt(2.0 * height": "2.0 * math.sqrt(height"})
mistakes(
    "HALF_NOT_ROOT",
    "Your result is height / g, which is half of what stands under the root.",
    "Take the root of 2 height / g. (Python reads x**1/2 as half of x: write x**0.5, or math.sqrt.)",
).edit("fall_time", {"math.sqrt(2.0 * height / g)": "(2.0 * height / g) ** 1 / 2"})

mistakes.accept(
    "The landing speed first, from the energy",
    """
        def fall_time(height, g=9.81):
            speed = math.sqrt(2.0 * g * height)
            return speed / g
    """,
)
mistakes.accept(
    "A power instead of a root",
    """
        def fall_time(height, g=9.81):
            return (2.0 * height / g) ** 0.5
    """,
)


def time_of(twice=2.0, root=0.5, gravity=lambda g: g):
    return lambda height, g=9.81: (twice * height / gravity(g)) ** root


mistakes.terms(
    "fall_time",
    time_of,
    {
        "twice": {"HALF_MISSING": 1.0, "HALF_TWICE": 0.5},
        "root": {"ROOT_MISSING": 1.0},
        "gravity": {"G_IGNORED": lambda g: 9.81, "G_MULTIPLIES": lambda g: 1 / g},
    },
)

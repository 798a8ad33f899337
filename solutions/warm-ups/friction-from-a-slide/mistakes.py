"""Mistakes in `friction-from-a-slide`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "HALF_MISSING",
    "The half is missing, as if the energy were m v^2, or the mean speed v.",
    "Kinetic energy is m v^2 / 2, and the mean speed of a slide is v / 2.",
).edit("friction_coefficient", {"/ (2.0 * g *": "/ (g *"})
mistakes(
    "SPEED_NOT_SQUARED",
    "The speed is not squared.",
    "At twice the speed it slides four times as far: energy goes with the square.",
).edit("friction_coefficient", {"return v * v / (2": "return v / (2"})
mistakes(
    "DECELERATION",
    "You did not divide by g: that gives a deceleration, in m/s^2.",
    "Divide by g: the coefficient is the ratio to gravity.",
).edit("friction_coefficient", {"* g * distance)": "* distance)"})
mistakes(
    "UPSIDE_DOWN",
    "The quotient is upside down: a longer slide gives more friction.",
    "The distance belongs in the denominator.",
).edit("friction_coefficient", {"v * v / (2.0 * g * distance": "2.0 * g * distance / (v * v"})
mistakes(
    "HALF_UPSIDE_DOWN",
    "You multiplied by 2 where the half of the kinetic energy divides.",
    "The energy is m v^2 / 2.",
)
mistakes(
    "G_IGNORED",
    "The argument g is not used.",
    "Divide by g, not by 9.81: on the Moon it is 1.62.",
)
mistakes(
    "G_MULTIPLIES",
    "You multiplied by g instead of dividing.",
    "Where gravity is stronger the same slide needs less friction: divide by g.",
)
mistakes(
    "BRACKETS_MISSING",
    "You divide by the 2 only: g and the distance multiply.",
    "Put brackets round all that divides: v**2 / (2 * g * distance).",
).edit("friction_coefficient", {"(2.0 * g * distance)": "2.0 * g * distance"})
mistakes(
    "DISTANCE_MULTIPLIES",
    "You multiplied by the distance.",
    "A longer slide means less friction: divide by it.",
).edit("friction_coefficient", {"(2.0 * g * distance)": "(2.0 * g) * distance"})

mistakes.accept(
    "By way of the deceleration",
    """
        def friction_coefficient(v, distance, g=9.81):
            deceleration = v**2 / distance / 2
            return deceleration / g
    """,
)
mistakes.accept(
    "By way of the time of the slide",
    """
        def friction_coefficient(v, distance, g=9.81):
            time = 2 * distance / v
            return v / (g * time)
    """,
)


def coefficient(half=0.5, power=2, gravity=lambda g: g, way=lambda s: s):
    return lambda v, distance, g=9.81: half * v**power / (gravity(g) * way(distance))


mistakes.terms(
    "friction_coefficient",
    coefficient,
    {
        "half": {"HALF_MISSING": 1.0, "HALF_UPSIDE_DOWN": 2.0},
        "power": {"SPEED_NOT_SQUARED": 1},
        "gravity": {
            "DECELERATION": lambda g: 1.0,
            "G_IGNORED": lambda g: 9.81,
            "G_MULTIPLIES": lambda g: 1 / g,
        },
        "way": {"DISTANCE_MULTIPLIES": lambda s: 1 / s},
    },
)

"""Mistakes in `too-fast-to-see`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "RADIUS_FORGOTTEN",
    "You took the ball as a point.",
    "The overlap begins when the front touches and ends when the back leaves: add the ball's diameter.",
).edit("fastest", {"(thickness + 2.0 * radius)": "thickness"})
mistakes(
    "RADIUS_ONCE",
    "The radius counts once: for the front or for the back of the ball, and not for both.",
    "Add the radius twice.",
).edit("fastest", {"+ 2.0 * radius)": "+ radius)"})
mistakes(
    "TIMES_THE_STEP",
    "The distance is multiplied by the step.",
    "A speed is a distance over a time: divide.",
).edit("fastest", {"radius) / h": "radius) * h"})
mistakes(
    "TWO_LOOKS",
    "Your condition asks for two looks inside the wall.",
    "One look is enough: the overlap has to last one step, not two.",
).edit("fastest", {"radius) / h": "radius) / (2.0 * h)"})
mistakes(
    "STEP_IGNORED",
    "Your result is a distance: the step is not used.",
    "A speed is a distance over a time: divide by h.",
)
mistakes(
    "THICKNESS_TWICE",
    "The thickness counts twice.",
    "The wall is crossed once. It is the radius that counts twice, for the front and for the back.",
).edit("fastest", {"(thickness + 2.0": "(2.0 * thickness + 2.0"})
mistakes(
    "BALL_INSIDE",
    "You took the way on which the whole ball is inside the wall.",
    "It overlaps the wall as long as any part is inside: add the ball's diameter.",
).edit("fastest", {"thickness + 2": "thickness - 2"})
mistakes(
    "STEP_OVER_DISTANCE",
    "The quotient is upside down.",
    "A speed is a distance over a time: divide by h.",
).edit("fastest", {"(thickness + 2.0 * radius) / h": "h / (thickness + 2.0 * radius)"})

mistakes.accept(
    "By the diameter",
    """
        def fastest(thickness, radius, h):
            diameter = radius + radius
            return (diameter + thickness) * (1.0 / h)
    """,
)
mistakes.accept(
    "Adds the speed of a point through the wall and of a ball through a plane",
    """
        def fastest(thickness, radius, h):
            return thickness / h + 2 * radius / h
    """,
)


def speed_of(walls=1, radii=2, per=lambda way, h: way / h):
    return lambda thickness, radius, h: per(walls * thickness + radii * radius, h)


mistakes.terms(
    "fastest",
    speed_of,
    {
        "walls": {"THICKNESS_TWICE": 2},
        "radii": {"RADIUS_FORGOTTEN": 0, "RADIUS_ONCE": 1},
        "per": {
            "TIMES_THE_STEP": lambda way, h: way * h,
            "TWO_LOOKS": lambda way, h: way / (2 * h),
            "STEP_IGNORED": lambda way, h: way,
        },
    },
)

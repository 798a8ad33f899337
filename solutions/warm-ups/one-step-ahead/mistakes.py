"""Mistakes in `one-step-ahead`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "NEW_VELOCITY",
    "The position moves with the new velocity.",
    "Use the velocity from before the step for the position. (What you wrote is a method of its own; the lesson comes to it.)",
)
mistakes(
    "SCHOOL_FORMULA",
    "The position has a term a h^2 / 2: you let the velocity change during the step.",
    "That is more exact for a constant acceleration. Here the velocity counts as constant during a step: leave the term out.",
).edit("step_ahead", {"h * v, v +": "h * v + a * h * h / 2, v +"})
mistakes(
    "STEP_FORGOTTEN",
    "The acceleration is added to the velocity without multiplying by the step.",
    "Acceleration is a change per second: multiply it by h.",
).edit("step_ahead", {"v + h * a": "v + a"})
mistakes(
    "VELOCITY_WITHOUT_STEP",
    "The velocity is added to the position without multiplying by the step.",
    "In a step of h seconds a body moves by h v.",
)
mistakes(
    "VELOCITY_KEPT",
    "The velocity does not change.",
    "It advances by h a.",
)
mistakes(
    "ORDER_SWAPPED",
    "Position and velocity are exchanged.",
    "The position comes first.",
)
mistakes(
    "SLOWER",
    "The acceleration is subtracted from the velocity.",
    "Add h a. Where it slows the body down, a itself is negative.",
)
mistakes(
    "CHANGES_ALONE",
    "You gave the changes of position and velocity, not their new values.",
    "Add them to x and v.",
).edit("step_ahead", {"x + h * v, v + h * a": "h * v, h * a"})
mistakes(
    "POSITION_KEPT",
    "The position does not change.",
    "It advances by h v.",
).edit("step_ahead", {"x + h * v": "x"})
mistakes(
    "DIVIDED_BY_THE_STEP",
    "You divided the rates by the step.",
    "In a step of h seconds a value changes by h times its rate.",
).edit("step_ahead", {"h * v, v + h * a": "v / h, v + a / h"})
mistakes(
    "RATES_SWAPPED",
    "You move the position with the acceleration, and the velocity with the velocity.",
    "The velocity is the rate of the position, and the acceleration that of the velocity.",
).edit("step_ahead", {"h * v, v + h * a": "h * a, v + h * v"})

mistakes.accept(
    "Adds up a list of pairs",
    """
        def step_ahead(x, v, a, h):
            return [now + h * rate for now, rate in ((x, v), (v, a))]
    """,
)
mistakes.accept(
    "Assigns both at once",
    """
        def step_ahead(x, v, a, h):
            x, v = x + v * h, v + a * h
            return x, v
    """,
)


def step_of(moved=lambda v, a, h: h * v, faster=lambda a, h: h * a, order=1):
    return lambda x, v, a, h: (x + moved(v, a, h), v + faster(a, h))[::order]


mistakes.terms(
    "step_ahead",
    step_of,
    {
        "moved": {
            "NEW_VELOCITY": lambda v, a, h: h * (v + h * a),
            "SCHOOL_FORMULA": lambda v, a, h: h * v + h * h * a / 2,
            "VELOCITY_WITHOUT_STEP": lambda v, a, h: v,
        },
        "faster": {
            "STEP_FORGOTTEN": lambda a, h: a,
            "VELOCITY_KEPT": lambda a, h: 0.0,
            "SLOWER": lambda a, h: -h * a,
        },
        "order": {"ORDER_SWAPPED": -1},
    },
)

"""Mistakes in `out-again`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "SLOP_IGNORED",
    "The slop is not used: resting bodies are pushed apart, fall back, and shake.",
    "Subtract the slop from the depth first.",
).edit("push_out", {"depth - slop,": "depth,"})
mistakes(
    "A_DISTANCE",
    "Your result is a distance, not a speed: the step is left out.",
    "Divide by h.",
).edit("push_out", {"return beta / h * max(": "return beta * max("})
mistakes(
    "PULLS_TOGETHER",
    "The speed can be negative, and then the bodies are pulled together.",
    "Where the depth is below the slop the speed is zero.",
).edit("push_out", {"max(depth - slop, 0.0": "(depth - slop"})
mistakes(
    "SLOP_FROM_THE_SPEED",
    "The slop, a length, is subtracted from a speed.",
    "Subtract it from the depth, where the units agree.",
).edit("push_out", {"return beta / h * max(depth -": "return max(beta / h * depth -"})
mistakes(
    "SLOP_ADDED",
    "The slop is added to the depth.",
    "The slop does not count: subtract it.",
)

mistakes.accept(
    "Two cases",
    """
        def push_out(depth, h, beta, slop):
            too_deep = depth - slop
            return too_deep * beta / h if too_deep > 0 else 0.0
    """,
)
mistakes.accept(
    "With NumPy's clip",
    """
        def push_out(depth, h, beta, slop):
            import numpy as np

            return float(np.clip(depth - slop, 0.0, None) * beta / h)
    """,
)


def speed_of(per=lambda h: h, less=1.0, least=0.0):
    return lambda depth, h, beta, slop: beta / per(h) * max(depth - less * slop, least)


mistakes.terms(
    "push_out",
    speed_of,
    {
        "per": {"A_DISTANCE": lambda h: 1.0},
        "less": {"SLOP_IGNORED": 0.0, "SLOP_ADDED": -1.0},
        "least": {"PULLS_TOGETHER": float("-inf")},
    },
)

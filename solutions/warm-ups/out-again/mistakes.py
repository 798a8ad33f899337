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
mistakes(
    "SLOP_AS_A_THRESHOLD",
    "Beyond the slop the whole depth counts: you use the slop only to decide whether to push.",
    "Its first part does not count: subtract the slop from the depth.",
).edit("push_out", {"max(depth - slop, 0.0)": "(depth if depth > slop else 0.0)"})
mistakes(
    "BETA_IGNORED",
    "beta is not used: everything beyond the slop is removed in one step.",
    "Remove the share beta of it: multiply by beta.",
).edit("push_out", {"beta / h": "1 / h"})
mistakes(
    "TIMES_THE_STEP",
    "You multiplied by the step.",
    "A speed is a distance over a time: divide by h.",
).edit("push_out", {"beta / h": "beta * h"})
mistakes(
    "SHARE_LEFT",
    "You took beta as the share that is left.",
    "It is the share that is removed.",
).edit("push_out", {"beta / h": "(1 - beta) / h"})
mistakes(
    "SIZE_OF_THE_DEPTH",
    "You took the depth without its sign, so bodies that are apart are pushed.",
    "A negative depth is a gap: there the speed is zero.",
).edit("push_out", {"max(depth": "max(abs(depth)"})
mistakes(
    "SLOP_AFTER_BETA",
    "You subtract the whole slop from the share beta of the depth.",
    "Subtract the slop from the depth first, then take the share.",
).edit("push_out", {"beta / h * max(depth - slop, 0.0)": "max(beta * depth - slop, 0.0) / h"})

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
        "per": {"A_DISTANCE": lambda h: 1.0, "TIMES_THE_STEP": lambda h: 1 / h},
        "less": {"SLOP_IGNORED": 0.0, "SLOP_ADDED": -1.0},
        "least": {"PULLS_TOGETHER": float("-inf")},
    },
)


@mistakes.more
def gaps_alone():
    yield (
        "push_out",
        ("PULLS_TOGETHER",),
        lambda depth, h, beta, slop: beta / h * (depth - slop) if depth > 0 else 0.0,
    )

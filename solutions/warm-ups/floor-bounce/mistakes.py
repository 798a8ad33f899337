"""Mistakes in `floor-bounce`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "TURNS_WHAT_RISES",
    "A ball that is already rising is sent down again: it sticks to the floor and shakes.",
    "Bounce only while the ball moves into the floor.",
).edit("after_floor", {"v if v < 0 else v": "v"})
mistakes(
    "NOT_TURNED_ROUND",
    "The ball slows down, but it does not turn round.",
    "The ball turns round: give the new velocity the opposite sign.",
).edit("after_floor", {"return -e *": "return e *"})
mistakes(
    "SHARE_OF_ENERGY",
    "You took e as a share of the energy.",
    "Restitution is a ratio of speeds: multiply by e, not by its root.",
).edit("after_floor", {"return -e * v": "return -(e**0.5) * v"})
mistakes(
    "RESTITUTION_IGNORED",
    "The ball keeps all its speed: e is not used.",
    "Multiply the speed by e.",
).edit("after_floor", {"return -e * v if": "return -v if"})
mistakes(
    "RISING_BOUNCES",
    "The condition is the wrong way round: a rising ball bounces, a falling one does not.",
    "Upwards is positive, so a ball on its way down has v < 0.",
)
mistakes(
    "RISING_STOPPED",
    "A ball that is already rising is stopped.",
    "It keeps its velocity: only a ball on its way down bounces.",
).body("after_floor", "return max(-e * v, 0.0)")
mistakes(
    "RISING_SLOWED",
    "A ball that is already rising loses speed, too.",
    "It keeps its velocity: only a ball on its way down bounces.",
).edit("after_floor", {"-e * v if v < 0 else v": "e * abs(v)"})
mistakes(
    "SHARE_LOST",
    "You took e as the share of the speed that is lost.",
    "e is the share that is left.",
).edit("after_floor", {"-e * v": "-(1 - e) * v"})
mistakes(
    "CHANGE_OF_VELOCITY",
    "A falling ball gets 1 + e times its speed: that is the change of its velocity.",
    "Its new speed is e times the old one.",
).edit("after_floor", {"-e * v": "-(1 + e) * v"})
mistakes(
    "SLOW_ONES_REST",
    "A slow ball stays on the floor.",
    "Every ball that moves into the floor bounces, however slow it is.",
).edit("after_floor", {"-e * v if v < 0": "0.0 if -0.05 < v < 0 else -e * v if v < 0"})
mistakes(
    "ZERO_NOT_TAKEN",
    "You do not take a restitution of 0 as it is given.",
    "Python takes 0 for false in `or` and in `if e`. With e = 0 the ball stays on the floor.",
).edit("after_floor", {"if v < 0": "if e and v < 0"})

mistakes.accept(
    "One formula for both cases",
    """
        def after_floor(v, e):
            incoming = (abs(v) - v) / 2
            return v + (1 + e) * incoming
    """,
)
mistakes.accept(
    "Takes the larger of two numbers",
    """
        def after_floor(v, e):
            return max(v, -e * v)
    """,
)


def bounce(falls=lambda v: v < 0, share=lambda e: e, turn=-1.0):
    return lambda v, e: turn * share(e) * v if falls(v) else v


mistakes.terms(
    "after_floor",
    bounce,
    {
        "falls": {"RISING_BOUNCES": lambda v: v > 0},
        "share": {
            "SHARE_OF_ENERGY": lambda e: e**0.5,
            "RESTITUTION_IGNORED": lambda e: 1.0,
            "SHARE_LOST": lambda e: 1 - e,
            "CHANGE_OF_VELOCITY": lambda e: 1 + e,
        },
        "turn": {"NOT_TURNED_ROUND": 1.0},
    },
)


@mistakes.more
def one_for_zero():
    yield "after_floor", ("ZERO_NOT_TAKEN",), bounce(share=lambda e: e or 1.0)

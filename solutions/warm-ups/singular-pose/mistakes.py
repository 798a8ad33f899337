"""Mistakes in `singular-pose`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "CARRIAGE_ALONE",
    "Your carriage moves at vx, as if the turning rod moved the tip only up and down.",
    "Differentiate x = s + length cos(angle): the rod has a share in it.",
).edit("joint_speeds", {" + length * math.sin(angle) * turn": ""})
mistakes(
    "SIGN_OF_THE_ROD",
    "The rod's share in x has the wrong sign.",
    "The derivative of a cosine has a minus. On the other side of the equation it becomes a plus.",
).edit("joint_speeds", {"vx + length": "vx - length"})
mistakes(
    "LENGTH_FORGOTTEN",
    "The rate of turning is not divided by the length.",
    "A tip that turns at one radian a second moves at length metres a second.",
).edit("joint_speeds", {"(length * math.cos(angle)": "math.cos(angle"})
mistakes(
    "NOT_DIFFERENTIATED",
    "You used y = length sin(angle) itself, not its rate.",
    "Differentiate: the rate of y is length cos(angle) times the rate of turning.",
).body(
    "joint_speeds",
    """
        if abs(math.cos(angle)) < 1e-9:
            return None
        if math.sin(angle) == 0.0:
            return vx, 0.0
        turn = vy / (length * math.sin(angle))
        return vx + length * math.cos(angle) * turn, turn
    """,
)
mistakes(
    "ORDER_SWAPPED",
    "The two speeds are swapped.",
    "The carriage comes first, then the rod.",
).edit("joint_speeds", {"vx + length * math.sin(angle) * turn,": "turn, vx + length * math.sin(angle) *"})
mistakes(
    "DEGREES",
    "You took the angle as degrees.",
    "It is in radians already.",
).around("joint_speeds", "return _right(math.radians(angle), length, vx, vy)")
mistakes(
    "TRANSPOSED",
    "You multiplied the velocity with a matrix instead of solving for the speeds.",
    "J takes speeds of joints to the velocity of the tip. You need the other direction.",
).body(
    "joint_speeds",
    """
        if abs(math.cos(angle)) < 1e-9:
            return None
        return vx, -length * math.sin(angle) * vx + length * math.cos(angle) * vy
    """,
)
mistakes(
    "FORWARDS",
    "You took vx and vy for the speeds of the joints, and gave the velocity of the tip.",
    "The velocity of the tip is known. Solve for the speeds.",
).body(
    "joint_speeds",
    """
        if abs(math.cos(angle)) < 1e-9:
            return None
        return vx - length * math.sin(angle) * vy, length * math.cos(angle) * vy
    """,
)
mistakes(
    "EXACTLY_ZERO",
    "You give huge speeds where the rod is upright.",
    "math.cos(math.pi / 2) is 6e-17, not 0. Compare its size with 1e-9.",
).edit("joint_speeds", {"abs(math.cos(angle)) < 1e-9": "math.cos(angle) == 0"})
mistakes(
    "ONLY_WHEN_ASKED",
    "In a singular pose you give an answer where vy is zero.",
    "There the rod may turn at many rates, so no pair is the answer: give None for every velocity.",
).edit("joint_speeds", {"return None": "return None if vy else (vx, 0.0)"})
mistakes(
    "FLAT_IS_SINGULAR",
    "You give None where the rod lies along the rail.",
    "There it moves its tip up and down easily. Which pose lets the tip only move along the rail?",
).edit("joint_speeds", {"(math.cos(angle)": "(math.sin(angle)"})
mistakes(
    "NO_SIZE_OF_COSINE",
    "You give None wherever the cosine is negative.",
    "Compare its size, abs(math.cos(angle)), with 1e-9.",
).edit("joint_speeds", {"abs(math.cos(angle)": "math.cos(angle"})
mistakes(
    "UPWARDS_ONLY",
    "You give None with the rod upwards, and speeds with the rod downwards.",
    "Downwards the cosine is zero, too: compare |cos(angle)| with 1e-9.",
).edit("joint_speeds", {"abs(math.cos(angle)) < 1e-9": "angle == math.pi / 2"})
mistakes(
    "FORWARDS_EVERYWHERE",
    "You multiplied J with (vx, vy): you took them for the speeds of the joints.",
    "The velocity of the tip is known. Solve for the speeds, and give None where that cannot be done.",
).body("joint_speeds", "return vx - length * math.sin(angle) * vy, length * math.cos(angle) * vy")
mistakes(
    "SINE_AND_COSINE_SWAPPED",
    "Sine and cosine are swapped, also where you look for the singular pose.",
    "Differentiate x and y: a cosine becomes minus a sine, a sine becomes a cosine.",
).edit(
    "joint_speeds",
    {
        "abs(math.cos": "abs(math.sin",
        "(length * math.cos": "(length * math.sin",
        "vx + length * math.sin": "vx - length * math.cos",
    },
)
mistakes(
    "COSINE_FORGOTTEN",
    "The rate of turning is vy over the length, in every pose.",
    "Differentiate y = length sin(angle): the cosine comes in.",
).edit("joint_speeds", {"(length * math.cos(angle))": "length"})
mistakes(
    "STANDS_STILL",
    "In a singular pose you give (0, 0), which says that nothing has to move.",
    "There the tip cannot have this velocity, or the rod may turn at many rates: give None.",
)
mistakes(
    "NAN_FOR_NONE",
    "In a singular pose you give nan.",
    "The README asks for None there.",
)
mistakes(
    "QUARTER_TURNS_ONLY",
    "You give None only for angles of a quarter turn, to either side.",
    "After a further half turn the rod is upright or hangs again: compare |cos(angle)| with 1e-9.",
).edit("joint_speeds", {"abs(math.cos(angle)) < 1e-9": "abs(abs(angle) - math.pi / 2) < 1e-9"})
mistakes(
    "RATE_FORGOTTEN",
    "The rod's share in x is not multiplied by the rate of turning.",
    "The derivative of cos(angle) is -sin(angle) times the rate.",
).edit("joint_speeds", {"math.sin(angle) * turn": "math.sin(angle)"})
mistakes(
    "NONE_IN_A_PAIR",
    "In a singular pose you give a pair of two None.",
    "Give None itself, not a pair: return None.",
)

mistakes.accept(
    "Solves J v = (vx, vy)",
    """
        def joint_speeds(angle, length, vx, vy):
            import numpy as np

            j = np.array([[1.0, -length * math.sin(angle)], [0.0, length * math.cos(angle)]])
            if abs(np.linalg.det(j)) < 1e-9 * length:
                return None
            return np.linalg.solve(j, [vx, vy])
    """,
)
mistakes.accept(
    "The rod moves the tip along x by a tangent",
    """
        def joint_speeds(angle, length, vx, vy):
            c = math.cos(angle)
            if -1e-9 < c < 1e-9:
                return None
            return [vx + vy * math.tan(angle), vy / length / c]
    """,
)


def speeds(share=1.0, length_of=float, order=1, singular=lambda c: abs(c) < 1e-9, none=None):
    def joint_speeds(angle, length, vx, vy):
        if singular(math.cos(angle)):
            return none
        turn = vy / (length_of(length) * math.cos(angle))
        return (vx + share * length * math.sin(angle) * turn, turn)[::order]

    return joint_speeds


mistakes.terms(
    "joint_speeds",
    speeds,
    {
        "share": {"SIGN_OF_THE_ROD": -1.0, "CARRIAGE_ALONE": 0.0},
        "length_of": {"LENGTH_FORGOTTEN": lambda length: 1.0},
        "order": {"ORDER_SWAPPED": -1},
        "singular": {"EXACTLY_ZERO": lambda c: c == 0.0},
        "none": {
            "STANDS_STILL": (0.0, 0.0),
            "NAN_FOR_NONE": (math.nan, math.nan),
            "NONE_IN_A_PAIR": (None, None),
        },
    },
)


@mistakes.more
def length_in_neither():
    def joint_speeds(angle, length, vx, vy):
        if abs(math.cos(angle)) < 1e-9:
            return None
        return vx + math.tan(angle) * vy, vy / math.cos(angle)

    yield "joint_speeds", ("LENGTH_FORGOTTEN",), joint_speeds

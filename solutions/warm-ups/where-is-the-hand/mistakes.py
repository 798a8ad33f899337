"""Mistakes in `where-is-the-hand`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes, with_terms

mistakes = Mistakes()

mistakes(
    "ELBOW_FROM_THE_AXIS",
    "You measure the second angle from the x axis.",
    "The elbow's motor turns with the first link: from the axis the second link points at a1 + a2.",
).body("hand", "return l1 * math.cos(a1) + l2 * math.cos(a2), l1 * math.sin(a1) + l2 * math.sin(a2)")
mistakes(
    "AXES_SWAPPED",
    "x and y are swapped, or sine and cosine.",
    "Measured from the x axis, x goes with the cosine.",
)
mistakes(
    "DEGREES",
    "You took the angles as degrees.",
    "They are in radians already.",
).around("hand", "return _right(math.radians(a1), math.radians(a2), l1, l2)")
mistakes(
    "ELBOW_TURNS_BACK",
    "The elbow turns clockwise.",
    "Both angles are counter-clockwise: add them.",
)
mistakes(
    "ONE_LONG_LINK",
    "You took the arm for one long link at the angle a1 + a2.",
    "The first link points at a1 alone: add the two links one by one.",
)
mistakes(
    "SECOND_LINK_ALONE",
    "You left out the first link.",
    "The second link begins at the elbow: add where that is.",
).edit("hand", {"l1 * math.cos(a1) + ": "", "l1 * math.sin(a1) + ": ""})
mistakes(
    "FIRST_LINK_ALONE",
    "Your result is where the elbow is.",
    "Add the second link, which points at a1 + a2.",
).edit("hand", {" + l2 * math.cos(a1 + a2)": "", " + l2 * math.sin(a1 + a2)": ""})
mistakes(
    "LINKS_EXCHANGED",
    "The lengths of the two links are exchanged.",
    "l1 goes with a1, and l2 with a1 + a2.",
).body(
    "hand", "return l2 * math.cos(a1) + l1 * math.cos(a1 + a2), l2 * math.sin(a1) + l1 * math.sin(a1 + a2)"
)
mistakes(
    "BOTH_AT_THE_FIRST_ANGLE",
    "You took the arm as stretched out: a2 is not used.",
    "The second link points at a1 + a2.",
).edit("hand", {"math.cos(a1 + a2)": "math.cos(a1)", "math.sin(a1 + a2)": "math.sin(a1)"})
mistakes(
    "ANGLES_SUBTRACTED",
    "Your second link points at a2 - a1 from the axis.",
    "The elbow turns with the first link: add the angles.",
).edit("hand", {"cos(a1 + a2)": "cos(a2 - a1)", "sin(a1 + a2)": "sin(a2 - a1)"})
mistakes(
    "ELBOW_ONCE_FROM_THE_AXIS",
    "In one of the two coordinates you measure the second angle from the x axis.",
    "Use a1 + a2 in both.",
).edit("hand", {"sin(a1 + a2)": "sin(a2)"})
mistakes(
    "ANGLE_BETWEEN_THE_LINKS",
    "You took a2 as the angle between the two links: with a2 = 0 your arm is folded.",
    "a2 is how far the second link turns from the direction of the first: add it to a1.",
).edit("hand", {"cos(a1 + a2)": "cos(a1 + math.pi - a2)", "sin(a1 + a2)": "sin(a1 + math.pi - a2)"})

mistakes.accept(
    "Turns of complex numbers",
    """
        def hand(a1, a2, l1, l2):
            import cmath

            end = cmath.exp(1j * a1) * (l1 + l2 * cmath.exp(1j * a2))
            return end.real, end.imag
    """,
)
mistakes.accept(
    "A rotation as a matrix",
    """
        def hand(a1, a2, l1, l2):
            import numpy as np

            def turned(a, vector):
                return np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]) @ vector

            elbow_to_hand = turned(a2, np.array([l2, 0.0]))
            return turned(a1, np.array([l1, 0.0]) + elbow_to_hand)
    """,
)


def hand_of(second=lambda a1, a2: a1 + a2, order=1, unit=lambda angle: angle):
    def hand(a1, a2, l1, l2):
        a1, a2 = unit(a1), unit(a2)
        end = second(a1, a2)
        x = l1 * math.cos(a1) + l2 * math.cos(end)
        return (x, l1 * math.sin(a1) + l2 * math.sin(end))[::order]

    return hand


def stretched(a1, a2, l1, l2):
    return (l1 + l2) * math.cos(a1 + a2), (l1 + l2) * math.sin(a1 + a2)


def once_from_the_axis(a1, a2, l1, l2):
    return l1 * math.cos(a1) + l2 * math.cos(a2), l1 * math.sin(a1) + l2 * math.sin(a1 + a2)


@mistakes.more
def hypotheses():
    yield "hand", ("ONE_LONG_LINK",), stretched
    yield "hand", ("ELBOW_ONCE_FROM_THE_AXIS",), once_from_the_axis
    yield "hand", ("ANGLE_BETWEEN_THE_LINKS",), hand_of(lambda a1, a2: a1 + a2 - math.pi)
    yield from with_terms(
        "hand",
        hand_of,
        {
            "second": {"ELBOW_FROM_THE_AXIS": lambda a1, a2: a2, "ELBOW_TURNS_BACK": lambda a1, a2: a1 - a2},
            "order": {"AXES_SWAPPED": -1},
            "unit": {"DEGREES": math.radians},
        },
    )

"""Mistakes in `hold-it-up`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "WEIGHT_AT_THE_END",
    "You let the weight act at the end of the bar.",
    "It acts at the centre of mass, half way along a uniform bar.",
).edit("holding_torque", {"return 0.5 * m *": "return m *"})
mistakes(
    "SINE_OF_THE_ANGLE",
    "You took the lever arm as a sine, so a level bar would need no torque.",
    "The angle is measured from the horizontal: the lever arm goes with its cosine.",
).edit("holding_torque", {"math.cos(angle": "math.sin(angle"})
mistakes(
    "ANGLE_IGNORED",
    "The angle is not used.",
    "A raised bar has its weight closer to the motor: multiply by the cosine.",
).edit("holding_torque", {"l * math.cos(angle)": "l"})
mistakes(
    "GRAVITYS_OWN_TORQUE",
    "Your result is the torque of gravity.",
    "The motor must cancel it: change the sign.",
).edit("holding_torque", {"return 0.": "return -0."})
mistakes(
    "DEGREES",
    "You took the angle as degrees.",
    "It is in radians already.",
)
mistakes(
    "SIZE_OF_THE_ARM",
    "You took the lever arm without its sign.",
    "Beyond upright the weight is on the other side, and the torque changes its sign: use the cosine as it is.",
).edit("holding_torque", {"math.cos(angle)": "abs(math.cos(angle))"})
mistakes(
    "G_IGNORED",
    "The argument g is not used.",
    "Multiply by g, not by 9.81: on the Moon it is 1.62.",
).edit("holding_torque", {"m * g": "m * 9.81"})
mistakes(
    "MASS_FOR_WEIGHT",
    "You took the mass for the weight: g is missing.",
    "The weight is m g.",
).edit("holding_torque", {"m * g": "m"})
mistakes(
    "TANGENT",
    "You took the lever arm as a tangent.",
    "The bar is the long side of the triangle, so the side along the horizontal goes with the cosine.",
).edit("holding_torque", {"math.cos": "math.tan"})
mistakes(
    "THIRD_OF_THE_LENGTH",
    "You let the weight act at a third of the length.",
    "It acts in the middle of a uniform bar. The third belongs to its moment of inertia.",
).edit("holding_torque", {"0.5 * m * g * l": "m * g * l / 3"})
mistakes(
    "NEVER_NEGATIVE",
    "Your torque is never negative.",
    "Beyond upright the weight is on the other side: there the motor must pull the other way.",
).edit("holding_torque", {"return 0.5": "return max(0.0, 0.5", "(angle)": "(angle))"})

mistakes.accept(
    "As a cross product",
    """
        def holding_torque(m, l, angle, g=9.81):
            import numpy as np

            arm = 0.5 * l * np.array([math.cos(angle), math.sin(angle), 0.0])
            return -float(np.cross(arm, [0.0, -m * g, 0.0])[2])
    """,
)
mistakes.accept(
    "The angle from the vertical",
    """
        def holding_torque(m, l, angle, g=9.81):
            return m * g * (l / 2) * math.sin(math.pi / 2 - angle)
    """,
)


def torque(arm=0.5, turn=math.cos, unit=float, sign=1.0, pull=lambda g: g):
    return lambda m, l, angle, g=9.81: sign * arm * m * pull(g) * l * turn(unit(angle))


mistakes.terms(
    "holding_torque",
    torque,
    {
        "arm": {"WEIGHT_AT_THE_END": 1.0},
        "turn": {
            "SINE_OF_THE_ANGLE": math.sin,
            "ANGLE_IGNORED": lambda angle: 1.0,
            "SIZE_OF_THE_ARM": lambda angle: abs(math.cos(angle)),
        },
        "unit": {"DEGREES": math.radians},
        "sign": {"GRAVITYS_OWN_TORQUE": -1.0},
        "pull": {"G_IGNORED": lambda g: 9.81, "MASS_FOR_WEIGHT": lambda g: 1.0},
    },
)

"""Mistakes in `let-it-go`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes, with_terms

mistakes = Mistakes()

mistakes(
    "INERTIA_ABOUT_THE_CENTRE",
    "You used the moment of inertia about the centre of the bar.",
    "The bar turns about its end, where it is four times as large: m l^2 / 3.",
).edit("angular_acceleration", {"* l / 3.0)": "* l / 12.0)"})
mistakes(
    "MASS_AT_THE_END",
    "You used the moment of inertia of a mass at the end of the bar.",
    "Most of a uniform bar is closer: m l^2 / 3.",
).edit("angular_acceleration", {"* l / 3.0)": "* l)"})
mistakes(
    "GRAVITY_UPWARDS",
    "Gravity turns the bar upwards.",
    "Gravity's torque is negative here: subtract it.",
).edit("angular_acceleration", {"torque - 0": "torque + 0"})
mistakes(
    "GRAVITY_FORGOTTEN",
    "Gravity is left out: with the motor off the bar would not fall.",
    "Subtract the torque that it takes to hold the bar.",
).edit("angular_acceleration", {"(torque - 0.5 * m * g * l * math.cos(angle))": "torque"})
mistakes(
    "WEIGHT_AT_THE_END",
    "You let the weight act at the end of the bar.",
    "It acts at the centre of mass, half way along a uniform bar.",
)
mistakes(
    "SINE_OF_THE_ANGLE",
    "You took the sine of the angle for the lever arm of the weight.",
    "The angle is measured from the horizontal: the lever arm goes with its cosine.",
)
mistakes(
    "ANGLE_IGNORED",
    "The angle is not used.",
    "A raised bar has its weight closer to the hinge: multiply by the cosine.",
)
mistakes(
    "DEGREES",
    "You took the angle as degrees.",
    "It is in radians already.",
)
mistakes(
    "TORQUE_NOT_DIVIDED",
    "Only gravity's torque is divided by the moment of inertia, not the motor's.",
    "Put brackets round the sum of the torques, and divide the sum.",
)
mistakes(
    "SIGN_TURNED",
    "The acceleration has the wrong sign.",
    "Positive is the direction in which the angle grows: take the motor's torque less gravity's.",
)
mistakes(
    "MASS_AT_THE_CENTRE",
    "You used the moment of inertia of a mass in the middle of the bar.",
    "Half of a uniform bar is farther out, and that counts more: m l^2 / 3.",
).edit("angular_acceleration", {"(m * l * l / 3.0)": "(m * (l / 2) ** 2)"})
mistakes(
    "SIZE_OF_THE_ARM",
    "You took the lever arm of the weight without its sign.",
    "Beyond upright the weight turns the bar the other way: use the cosine as it is.",
).edit("angular_acceleration", {"math.cos(angle)": "abs(math.cos(angle))"})
mistakes(
    "G_IGNORED",
    "The argument g is not used.",
    "Multiply by g, not by 9.81: on the Moon it is 1.62.",
).edit("angular_acceleration", {"m * g": "m * 9.81"})
mistakes(
    "INERTIA_NOT_USED",
    "Your result is the sum of the torques.",
    "Divide it by the moment of inertia about the end.",
).edit("angular_acceleration", {" / (m * l * l / 3.0)": ""})
mistakes(
    "LENGTH_NOT_SQUARED",
    "The length in the moment of inertia is not squared, or your result is the acceleration of the end in m/s^2.",
    "The moment of inertia is m l^2 / 3, and the torque over it is the result, in rad/s^2.",
).edit("angular_acceleration", {"(m * l * l / 3.0)": "(m * l / 3.0)"})
mistakes(
    "BRACKETS_MISSING",
    "You multiply by what stands behind the first slash: brackets are missing.",
    "Put brackets round the moment of inertia: torque / (m * l**2 / 3).",
).edit("angular_acceleration", {"(m * l * l / 3.0)": "m * l * l / 3.0"})
mistakes(
    "MOTOR_FORGOTTEN",
    "The motor's torque is not used.",
    "Add it to gravity's before you divide.",
)
mistakes(
    "LENGTH_LOST_IN_GRAVITY",
    "Gravity's part of your result does not depend on the length.",
    "A longer bar falls more slowly: without a torque it is -1.5 g cos(angle) / l.",
).edit("angular_acceleration", {"m * g * l": "m * g * l * l"})

mistakes.accept(
    "The moment of inertia by the parallel axis theorem",
    """
        def angular_acceleration(torque, m, l, angle, g=9.81):
            inertia = m * l**2 / 12 + m * (l / 2) ** 2
            gravity = -m * g * l / 2 * math.cos(angle)
            return (torque + gravity) / inertia
    """,
)
mistakes.accept(
    "Motor and gravity apart",
    """
        def angular_acceleration(torque, m, l, angle, g=9.81):
            return 3 * torque / (m * l**2) - 1.5 * g / l * math.cos(angle)
    """,
)


def acceleration(
    inertia=1 / 3, turned=1.0, arm=0.5, turn=math.cos, unit=float, gravity=-1.0, motor=1.0, pull=float
):
    return lambda torque, m, l, angle, g=9.81: (
        turned
        * (motor * torque + gravity * arm * m * pull(g) * l * turn(unit(angle)))
        / (inertia * m * l * l)
    )


def torque_undivided(torque, m, l, angle, g=9.81):
    return torque - 1.5 * g / l * math.cos(angle)


@mistakes.more
def hypotheses():
    yield "angular_acceleration", ("TORQUE_NOT_DIVIDED",), torque_undivided
    yield from with_terms(
        "angular_acceleration",
        acceleration,
        {
            "inertia": {
                "INERTIA_ABOUT_THE_CENTRE": 1 / 12,
                "MASS_AT_THE_CENTRE": 1 / 4,
                "MASS_AT_THE_END": 1.0,
            },
            "turned": {"SIGN_TURNED": -1.0},
            "arm": {"WEIGHT_AT_THE_END": 1.0},
            "turn": {
                "SINE_OF_THE_ANGLE": math.sin,
                "ANGLE_IGNORED": lambda angle: 1.0,
                "SIZE_OF_THE_ARM": lambda angle: abs(math.cos(angle)),
            },
            "unit": {"DEGREES": math.radians},
            "gravity": {"GRAVITY_UPWARDS": 1.0, "GRAVITY_FORGOTTEN": 0.0},
            "motor": {"MOTOR_FORGOTTEN": 0.0},
            "pull": {"G_IGNORED": lambda g: 9.81},
        },
    )

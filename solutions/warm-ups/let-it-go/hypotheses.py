"""Accelerations with one term wrong, or two."""

import math

from course.scoring import kit


def acceleration(inertia=1 / 3, turned=1.0, arm=0.5, turn=math.cos, unit=float, gravity=-1.0):
    return lambda torque, m, l, angle, g=9.81: (
        turned * (torque + gravity * arm * m * g * l * turn(unit(angle))) / (inertia * m * l * l)
    )


def torque_undivided(torque, m, l, angle, g=9.81):
    return torque - 1.5 * g / l * math.cos(angle)


def hypotheses():
    yield "angular_acceleration", ("TORQUE_NOT_DIVIDED",), torque_undivided
    yield from kit.terms(
        "angular_acceleration",
        acceleration,
        {
            "inertia": {"INERTIA_ABOUT_THE_CENTRE": 1 / 12, "MASS_AT_THE_END": 1.0},
            "turned": {"SIGN_TURNED": -1.0},
            "arm": {"WEIGHT_AT_THE_END": 1.0},
            "turn": {"SINE_OF_THE_ANGLE": math.sin, "ANGLE_IGNORED": lambda angle: 1.0},
            "unit": {"DEGREES": math.radians},
            "gravity": {"GRAVITY_UPWARDS": 1.0, "GRAVITY_FORGOTTEN": 0.0},
        },
    )

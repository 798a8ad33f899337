"""Torques with one term wrong, or two."""

import math

from course.scoring import kit


def torque(arm=0.5, turn=math.cos, unit=float, sign=1.0):
    return lambda m, l, angle, g=9.81: sign * arm * m * g * l * turn(unit(angle))


def hypotheses():
    return kit.terms(
        "holding_torque",
        torque,
        {
            "arm": {"WEIGHT_AT_THE_END": 1.0},
            "turn": {"SINE_OF_THE_ANGLE": math.sin, "ANGLE_IGNORED": lambda angle: 1.0},
            "unit": {"DEGREES": math.radians},
            "sign": {"GRAVITYS_OWN_TORQUE": -1.0},
        },
    )

"""Coefficients with one term wrong, or two."""

from course.scoring import kit


def coefficient(half=0.5, power=2, gravity=lambda g: g):
    return lambda v, distance, g=9.81: half * v**power / (gravity(g) * distance)


def hypotheses():
    return kit.terms(
        "friction_coefficient",
        coefficient,
        {
            "half": {"HALF_MISSING": 1.0, "HALF_UPSIDE_DOWN": 2.0},
            "power": {"SPEED_NOT_SQUARED": 1},
            "gravity": {
                "DECELERATION": lambda g: 1.0,
                "G_IGNORED": lambda g: 9.81,
                "G_MULTIPLIES": lambda g: 1 / g,
            },
        },
    )

"""Factors with one term wrong, or two."""

from course.scoring import kit


def factor_of(length=lambda h: h, quotient=lambda time, wall: time / wall, size=1.0):
    return lambda steps, h, wall: size * quotient(steps * length(h), wall)


def hypotheses():
    return kit.terms(
        "real_time_factor",
        factor_of,
        {
            "length": {"STEPS_PER_SECOND": lambda h: 1.0, "DIVIDED_BY_THE_STEP": lambda h: 1 / h},
            "quotient": {
                "UPSIDE_DOWN": lambda time, wall: wall / time,
                "WALL_IGNORED": lambda time, wall: time,
                "WHOLE_NUMBERS": lambda time, wall: time // wall,
            },
            "size": {"PER_CENT": 100.0},
        },
    )

"""Times with one term wrong, or two."""

from course.scoring import kit


def time_of(twice=2.0, root=0.5, gravity=lambda g: g):
    return lambda height, g=9.81: (twice * height / gravity(g)) ** root


def hypotheses():
    return kit.terms(
        "fall_time",
        time_of,
        {
            "twice": {"HALF_MISSING": 1.0, "HALF_TWICE": 0.5},
            "root": {"ROOT_MISSING": 1.0},
            "gravity": {"G_IGNORED": lambda g: 9.81, "G_MULTIPLIES": lambda g: 1 / g},
        },
    )

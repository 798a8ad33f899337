"""Speeds with one term wrong, or two."""

from course.scoring import kit


def speed_of(radii=2, per=lambda way, h: way / h):
    return lambda thickness, radius, h: per(thickness + radii * radius, h)


def hypotheses():
    return kit.terms(
        "fastest",
        speed_of,
        {
            "radii": {"RADIUS_FORGOTTEN": 0, "RADIUS_ONCE": 1},
            "per": {
                "TIMES_THE_STEP": lambda way, h: way * h,
                "TWO_LOOKS": lambda way, h: way / (2 * h),
                "STEP_IGNORED": lambda way, h: way,
            },
        },
    )

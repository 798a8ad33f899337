"""Steps with one term wrong, or two."""

from course.scoring import kit


def step_of(moved=lambda v, a, h: h * v, faster=lambda a, h: h * a, order=1):
    return lambda x, v, a, h: (x + moved(v, a, h), v + faster(a, h))[::order]


def hypotheses():
    return kit.terms(
        "step_ahead",
        step_of,
        {
            "moved": {
                "NEW_VELOCITY": lambda v, a, h: h * (v + h * a),
                "SCHOOL_FORMULA": lambda v, a, h: h * v + h * h * a / 2,
                "VELOCITY_WITHOUT_STEP": lambda v, a, h: v,
            },
            "faster": {
                "STEP_FORGOTTEN": lambda a, h: a,
                "VELOCITY_KEPT": lambda a, h: 0.0,
                "SLOWER": lambda a, h: -h * a,
            },
            "order": {"ORDER_SWAPPED": -1},
        },
    )

"""Loops with one term wrong, or two."""

from course.scoring import kit


def swing_of(old=False, of_x=lambda h: h, of_v=lambda h: h, sign=-1.0, mass=lambda m: m):
    def swing(x, v, k, m, h, n):
        for _ in range(n):
            before, v = v, v + of_v(h) * sign * k / mass(m) * x
            x += of_x(h) * (before if old else v)
        return x, v

    return swing


def hypotheses():
    return kit.terms(
        "swing",
        swing_of,
        {
            "old": {"BOTH_OLD": True},
            "of_x": {"STEP_MISSING_IN_X": lambda h: 1.0},
            "of_v": {"STEP_MISSING_IN_V": lambda h: 1.0},
            "sign": {"FORCE_AWAY": 1.0},
            "mass": {"MASS_LOST": lambda m: 1.0},
        },
    )

"""Corrections with one term wrong, or two."""

from course.scoring import kit


def corrected_by(start=lambda p, m: p, way=lambda p, m: m - p, share=lambda s: s):
    return lambda predicted, measured, s: start(predicted, measured) + share(s) * way(predicted, measured)


def hypotheses():
    return kit.terms(
        "corrected",
        corrected_by,
        {
            "start": {"CORRECTION_ALONE": lambda p, m: 0.0, "FROM_THE_MEASUREMENT": lambda p, m: m},
            "way": {"AWAY_FROM_THE_SENSOR": lambda p, m: p - m, "MEASUREMENT_ADDED": lambda p, m: m},
            "share": {"SHARES_SWAPPED": lambda s: 1 - s},
        },
    )

"""Wrong programs for the tasks of ``digital-twin``, as functions: what a diagnosis is compared with.

They are the right ones of ``formulas.py`` (sensors) and ``motions.py`` (the rest), a term or two at a time in
another form.
"""

from __future__ import annotations

import itertools

from course.scoring import kit

formulas, motions = (kit.sibling(__file__, name) for name in ("formulas", "motions"))

#: What else is true of a program with a mistake, by its code.
ALSO = {"COUNTS_ARE_STEPS": ("COUNTS_DEPEND_ON_OTHERS",)}


def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for task, families in (formulas.TERMS | motions.TERMS).items():
        for codes, function in motions.OTHERS.get(task, ()):
            yield task, codes, function
        for family, base, terms in families:
            for term, forms in terms.items():
                for code, form in forms:
                    yield task, (*_of_base(base), code), family(**base | {term: form})
        for family, base, terms in families[:2]:  # what a third has twice, the first two have
            yield from _pairs(task, family, base, terms)


def _of_base(base):
    """What is wrong with a family before any of its terms is, whatever else."""
    if base is motions._EULER:
        return ("EULER_ODOMETRY",)
    if base.get("gain", 0.0) < 0.0:
        return ("PUSHES_AWAY",)
    return ("EULER_TURNS_FIRST",) if base is motions._TURNED_FIRST else ()


#: Mistakes that hardly anybody makes together with another: the table has room for 260 pairs of a task.
_ALONE = {
    *("LAG_BASE", "LAG_OF_PRODUCT", "LAG_OFF_BY_FACTOR", "LAG_RATIO_INVERTED", "DEADBAND_REVERSED"),
    *("SPEED_GROWS", "SATURATION_AS_SWITCH"),
    *("ANGLES_IGNORED", "BEAM_REVERSED", "NOTHING_IS_HIT", "POSITION_SIGN_FLIPPED", "RANGE_MADE_POSITIVE"),
    *("LIDAR_SIGMA_ROOT", "LIDAR_NOISE_ONE_SIDED", "LIDAR_NOISE_UNIFORM", "DISTANCE_ALONG_HEADING"),
    *("LIDAR_NOISE_PROPORTIONAL", "DISTANCE_SQUARED"),
    *("WHITE_NOISE_TIMES_DT", "WHITE_NOISE_ONE_SIDED", "BIAS_WALKS_TO_BIAS0", "BIAS_OVER_SQRT_DT"),
    *("NOISE_FOR_BIAS", "BIAS_SUBTRACTED", "TRUE_RATE_MISSING", "BIAS0_ADDED_EACH_STEP"),
    *("BIAS_CONSTANT", "WHITE_NOISE_MISSING", "WALK_SQUARED", "DENSITY_SQUARED"),
    *("Y_MIRRORED", "SPEED_IS_DIFFERENCE", "HEADING_HALF_TURNED", "CHORD_TURNED_BACK", "TRACK_MULTIPLIED"),
    *("SPEED_OF_ONE_WHEEL", "WAY_WITHOUT_DT", "TRACK_IGNORED", "HEADING_FORGOTTEN"),
}


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    if _of_base(base):
        return  # that would be three
    firsts = {
        term: [(code, form) for code, form in dict(reversed(forms)).items() if code not in _ALONE]
        for term, forms in terms.items()
    }
    for one, other in itertools.combinations(terms, 2):
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other]):
            if code != second:
                yield task, (code, second), family(**base | {one: form, other: another})

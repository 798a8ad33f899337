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
    """What is wrong with a family before any of its terms is: those that roll straight, whatever else."""
    if base is motions._EULER:
        return ("EULER_ODOMETRY",)
    return ("EULER_TURNS_FIRST",) if base is motions._TURNED_FIRST else ()


#: Programs with two mistakes that are made for a family, spread evenly over what there is.
_MOST = 100


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    if _of_base(base):
        return  # that would be three
    firsts = {term: dict(reversed(forms)).items() for term, forms in terms.items()}
    pairs = [
        ((code, second), {one: form, other: another})
        for one, other in itertools.combinations(terms, 2)
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other])
        if code != second
    ]
    for codes, wrong in pairs[:: max(1, len(pairs) // _MOST)]:
        yield task, codes, family(**base | wrong)

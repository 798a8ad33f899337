"""``choose_engine``, right or with slips in it: for questions that are drawn, and what a diagnosis knows."""

from __future__ import annotations

import math
import operator

_OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": operator.eq}


def meets(report, need):
    """A value that is there and stands to the required one as the operator says."""
    value = report.get(need["key"])
    return value is not None and bool(_OPERATORS[need["op"]](value, need["value"]))


def choose(reports, needs, *, met=meets, enough=all, cost=1.0, none=None):
    """The choice.

    Args:
        met: whether a report meets one requirement.
        enough: of the answers for all requirements, whether the engine fits: all, any.
        cost: 1 takes the cheapest, -1 the dearest, 0 the first.
        none: what is returned where none fits.
    """
    fitting = [name for name, report in reports.items() if enough([met(report, need) for need in needs])]
    return min(fitting, key=lambda name: cost * reports[name]["cost"], default=none)


# -- the same questions in other words ----------------------------------------------------------------------


def names(rng, count):
    """Names that mean nothing."""
    letters = "bcdfghklmnprstvz"
    made = set()
    while len(made) < count:
        made.add("".join(rng.choice(list(letters)) + rng.choice(list("aeiou")) for _ in range(3)))
    return [str(name) for name in rng.permutation(sorted(made))]


def retold(rng, questions):
    """Questions (reports, needs, answer) with other names, another order, and costs in another currency.

    A name stays the same in all of them: whoever keeps answers by names is asked again.
    """
    known = list(dict.fromkeys(name for reports, *_ in questions for name in reports))
    other = dict(zip(known, names(rng, len(known)), strict=True))
    return [_retold(rng, other, *question) for question in questions]


def _retold(rng, other, reports, needs, answer):
    rate = float(rng.uniform(0.5, 3.0))
    shuffled = [str(name) for name in rng.permutation(list(reports))]
    return (
        {other[name]: {**reports[name], "cost": rate * reports[name]["cost"]} for name in shuffled},
        [needs[i] for i in rng.permutation(len(needs))],
        None if answer is None else other[answer],
    )


# -- slips in one requirement ------------------------------------------------------------------------------


def _missing(report, need):
    return report.get(need["key"]) is None


def _missing_is_zero(report, need):
    return meets({**report, need["key"]: report.get(need["key"]) or 0}, need)


def _strictly(report, need):
    return meets(report, need) and (need["op"] == "==" or report[need["key"]] != need["value"])


def _strictly_at(op):
    """Equality is left out of one operator only."""
    return lambda report, need: (_strictly if need["op"] == op else meets)(report, need)


def _nearly(report, need):
    if need["op"] != "==" or isinstance(need["value"], bool) or _missing(report, need):
        return meets(report, need)
    return math.isclose(report[need["key"]], need["value"], rel_tol=0.02)


def _within_rounding(report, need):
    value = report.get(need["key"])
    return meets(report, need) or (value is not None and math.isclose(value, need["value"]))


def _within_rounding_of_limits(report, need):
    return meets(report, need) if need["op"] == "==" else _within_rounding(report, need)


def _missing_equals_nothing(report, need):
    if _missing(report, need):
        return need["op"] == "==" and not need["value"]
    return meets(report, need)


def _of_one_type(report, need):
    alike = type(report.get(need["key"])) is type(need["value"])
    return meets(report, need) and (need["op"] != "==" or alike)


def _as_truths(report, need):
    if need["op"] != "==" or _missing(report, need):
        return meets(report, need)
    return bool(report[need["key"]]) == bool(need["value"])


def _finite(report, need):
    return meets(report, need) and math.isfinite(report[need["key"]])


def _no_number_equal(report, need):
    """Two equal numbers are seldom one object, and never if they are of different types."""
    value = report.get(need["key"])
    return _of_one_type(report, need) and not (need["op"] == "==" and isinstance(value, float))


def _with_operators(**others):
    """Operators read as others; "" takes no notice of it."""

    def met(report, need):
        op = others.get({"<=": "le", ">=": "ge", "==": "eq"}[need["op"]], need["op"])
        return not _missing(report, need) if not op else meets(report, {**need, "op": op})

    return met


def _never(op):
    """Requirements with one operator are never met."""
    return lambda report, need: need["op"] != op and meets(report, need)


#: code: the same slip in several forms
METS = {
    "IGNORES_MISSING": (
        lambda report, need: _missing(report, need) or meets(report, need),
        lambda report, need: need["key"] not in report or meets(report, need),
        lambda report, need: (need["key"] in report and report[need["key"]] is None) or meets(report, need),
        _missing_is_zero,
        _missing_equals_nothing,
    ),
    "INFINITE_TAKEN_FOR_MISSING": (_finite,),
    "BOOLS_NOT_MEASURED": (
        lambda report, need: not isinstance(report.get(need["key"]), bool) and meets(report, need),
    ),
    "ZERO_TAKEN_FOR_MISSING": (lambda report, need: bool(report.get(need["key"])) and meets(report, need),),
    "STRICT_COMPARISON": (_strictly, _strictly_at("<="), _strictly_at(">=")),
    "EQUALITY_ROUGH": (_nearly, _within_rounding, _within_rounding_of_limits),
    "EQUALITY_BY_TYPE": (_of_one_type,),
    "EQUALITY_OF_TRUTH": (_as_truths,),
    "EQUALITY_BY_IDENTITY": (_no_number_equal,),
    "OPERATOR_CONFUSED": (
        _with_operators(le=">=", ge="<="),
        _with_operators(le="<=", ge="<=", eq="<="),
        _with_operators(le=">=", ge=">=", eq=">="),
        _with_operators(le="==", ge="==", eq="=="),
        _with_operators(eq="<="),
        _with_operators(eq=">="),
        _with_operators(le=">="),
        _with_operators(ge="<="),
        _with_operators(le="=="),
        _with_operators(ge="=="),
    ),
    "OPERATOR_NEVER_MET": tuple(map(_never, ("<=", ">=", "=="))),
    "OPERATOR_IGNORED": (_with_operators(eq=""), _with_operators(le=""), _with_operators(ge="")),
}


# -- slips in the rest -------------------------------------------------------------------------------------


def _cheapest_first(reports, needs, met=meets):
    name = choose(reports, [])
    return name if name is not None and all(met(reports[name], need) for need in needs) else None


def _all_or_none(reports, needs, met=meets):
    every = all(met(report, need) for report in reports.values() for need in needs)
    return choose(reports, []) if every else None


def _to_the_first_misfit(reports, needs, met=meets):
    seen = {}
    for name, report in reports.items():
        if not all(met(report, need) for need in needs):
            break
        seen[name] = report
    return choose(seen, [])


def _most_met(reports, needs, met=meets):
    if not reports:
        return None
    return min(reports, key=lambda n: (-sum(met(reports[n], need) for need in needs), reports[n]["cost"]))


def _some(answers):
    return any(answers) or not answers


def _capped(most):
    def choice(reports, needs, met=meets):
        return choose({name: r for name, r in reports.items() if r["cost"] < most}, needs, met=met)

    return choice


def _priced(form, last=False):
    """Costs as ``form`` makes them; of equal ones the first, or the last."""

    def choice(reports, needs, met=meets):
        names = reversed(list(reports)) if last else reports
        return choose({n: {**reports[n], "cost": form(reports[n]["cost"])} for n in names}, needs, met=met)

    return choice


def _free_is_none(reports, needs, met=meets):
    best = None
    for name, report in reports.items():
        cheaper = best is None or not reports[best]["cost"] or report["cost"] < reports[best]["cost"]
        if cheaper and all(met(report, need) for need in needs):
            best = name
    return best


def _one_for_each_key(which):
    def choice(reports, needs, met=meets):
        return choose(reports, list({need["key"]: need for need in needs[::which]}.values()), met=met)

    return choice


def _alphabetical(reports, needs, met=meets):
    return min((n for n, r in reports.items() if all(met(r, need) for need in needs)), default=None)


def _one_of(which):
    return lambda reports, needs, met=meets: choose(reports, needs[which], met=met)


def _reports(reports, needs, met=meets):
    name = choose(reports, needs, met=met)
    return None if name is None else reports[name]


def _loud(reports, needs, met=meets):
    name = choose(reports, needs, met=met)
    if name is None:
        raise ValueError("none fits")
    return name


def _told(form):
    return lambda reports, needs, met=meets: form(choose(reports, needs, met=met), reports)


def _all_that_fit(reports, needs, met=meets):
    fitting = [n for n, r in reports.items() if all(met(r, need) for need in needs)]
    return sorted(fitting, key=lambda n: reports[n]["cost"])


#: code: (reports, needs, met) -> choice, in several forms
CHOICES = {
    "REQUIREMENTS_IGNORED": (lambda reports, needs, met=meets: choose(reports, []),),
    "COST_BEFORE_REQUIREMENTS": (_cheapest_first,),
    "ALL_MUST_FIT": (_all_or_none,),
    "STOPS_AT_MISFIT": (_to_the_first_misfit,),
    "COST_REVERSED": (lambda reports, needs, met=meets: choose(reports, needs, met=met, cost=-1.0),),
    "COST_IGNORED": (
        lambda reports, needs, met=meets: choose(reports, needs, met=met, cost=0.0),
        lambda reports, needs, met=meets: choose(dict(reversed(reports.items())), needs, met=met, cost=0.0),
    ),
    "COST_CAPPED": tuple(_capped(10.0**power) for power in range(2, 9)),
    "COST_ROUGH": tuple(
        _priced(lambda cost, digits=digits: round(cost, digits), last)
        for digits in (None, 0, 1, 2, 3, 6, -1)
        for last in (False, True)
    )
    + tuple(_priced(int, last) for last in (False, True)),
    "COST_OF_NOTHING": (
        _free_is_none,
        _priced(lambda cost: cost or math.inf),
        lambda reports, needs, met=meets: choose(
            {n: r for n, r in reports.items() if r["cost"]}, needs, met=met
        ),
    ),
    "DEPENDS_ON_NAMES": (_alphabetical,),
    "ANY_INSTEAD_OF_ALL": (
        lambda reports, needs, met=meets: choose(reports, needs, met=met, enough=any),
        lambda reports, needs, met=meets: choose(reports, needs, met=met, enough=_some),
        _most_met,
    ),
    "ONE_FOR_EACH_KEY": (_one_for_each_key(1), _one_for_each_key(-1)),
    "FIRST_REQUIREMENT_ONLY": (_one_of(slice(1)), _one_of(slice(-1, None))),
    "NEVER_CHOOSES": (lambda reports, needs, met=meets: None,),
    "NOTHING_FITS": (
        lambda reports, needs, met=meets: choose(reports, needs, met=met) or choose(reports, []),
        lambda reports, needs, met=meets: choose(reports, needs, met=met, none=""),
        lambda reports, needs, met=meets: choose(reports, needs, met=met, none="None"),
        lambda reports, needs, met=meets: choose(reports, needs, met=met, none="none"),
        lambda reports, needs, met=meets: choose(reports, needs, met=met, none=False),
        _loud,
    ),
    "NOT_A_NAME": (
        _reports,
        _all_that_fit,
        _told(lambda name, reports: None if name is None else (name, reports[name]["cost"])),
        _told(lambda name, reports: None if name is None else [name]),
        _told(lambda name, reports: None if name is None else reports[name]["cost"]),
        _told(lambda name, reports: None if name is None else list(reports).index(name)),
    ),
}

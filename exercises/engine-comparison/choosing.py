"""Judging ``choose_engine``: what it chose, and which slip would have chosen that."""

from __future__ import annotations

import operator
from typing import Any

from course.grading import kit

diagnosis = kit.companion("engine-comparison", "diagnosis")

TASK = "choose_engine"
_OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": operator.eq}


def expect_choices(submission: Any, questions: list[tuple[Any, Any, Any]]) -> None:
    """Each question (reports, requirements, the right name or None) is answered rightly.

    All of them are asked in one round trip.
    """
    answers = submission.call_each(TASK, [(reports, needs) for reports, needs, _ in questions])
    everything = list(zip(questions, answers, strict=True))
    for (reports, needs, expected), answer in everything:
        given = {"requirements": needs, "reports, cut to what decides": _what_decides(reports, needs)}
        if answer is not None and not (isinstance(answer, str) and answer in reports):
            kit.fail(
                "choose_engine returns something that is neither one of the names nor None.",
                diagnose=diagnosis.named("NOTHING_FITS" if expected is None else "NOT_A_NAME"),
                input=given,
                expected=expected,
                actual=answer,
            )
        if answer != expected:
            kit.fail(
                "No engine meets every requirement, and one is chosen all the same."
                if expected is None
                else "It is not the cheapest engine that meets every requirement.",
                help="Keep the engines that meet all requirements, then take the one with the least cost.",
                diagnose=lambda: of_choices(everything),
                input=given,
                expected=expected,
                actual=answer,
            )


def _what_decides(reports: Any, needs: Any) -> Any:
    """Of each report the required keys and the cost: the answer depends on nothing else."""
    keys = [*dict.fromkeys(need["key"] for need in needs), "cost"]
    return {name: {key: report[key] for key in keys if key in report} for name, report in reports.items()}


def choose(reports: Any, needs: Any, *, met: Any = None, enough: Any = all, cost: float = 1.0) -> Any:
    """The choice, right or with one slip in it.

    Args:
        met: whether a report meets one requirement.
        enough: how many have to be met: all, any.
        cost: 1 takes the cheapest, -1 the dearest, 0 the first.
    """
    met = met or meets
    fitting = [name for name, report in reports.items() if enough(met(report, need) for need in needs)]
    return min(fitting, key=lambda name: cost * reports[name]["cost"], default=None)


def meets(report: Any, need: Any) -> bool:
    """A value that is there and stands to the required one as the operator says."""
    value = report.get(need["key"])
    return value is not None and bool(_OPERATORS[need["op"]](value, need["value"]))


def _meets_or_missing(report: Any, need: Any) -> bool:
    return report.get(need["key"]) is None or meets(report, need)


def _meets_or_lacks(report: Any, need: Any) -> bool:
    return need["key"] not in report or meets(report, need)


def _meets_or_none(report: Any, need: Any) -> bool:
    return (need["key"] in report and report[need["key"]] is None) or meets(report, need)


def _missing_is_zero(report: Any, need: Any) -> bool:
    return meets({**report, need["key"]: report.get(need["key"]) or 0}, need)


def _strictly(report: Any, need: Any) -> bool:
    value = report.get(need["key"])
    return meets(report, need) and (need["op"] == "==" or value != need["value"])


def _reversed(report: Any, need: Any) -> bool:
    return meets(report, {**need, "op": {"<=": ">=", ">=": "<="}.get(need["op"], "==")})


def _always(op: str) -> Any:
    return lambda report, need: meets(report, {**need, "op": op})


def _cheapest_first(reports: Any, needs: Any) -> Any:
    name = choose(reports, [])
    return name if name is not None and all(meets(reports[name], need) for need in needs) else None


def _most_met(reports: Any, needs: Any) -> Any:
    if not reports:
        return None
    return min(reports, key=lambda n: (-sum(meets(reports[n], need) for need in needs), reports[n]["cost"]))


#: Slips in the order in which they are looked for.
SLIPS: list[tuple[str, Any]] = [
    ("REQUIREMENTS_IGNORED", lambda reports, needs: choose(reports, [])),
    ("COST_BEFORE_REQUIREMENTS", _cheapest_first),
    ("IGNORES_MISSING", lambda reports, needs: choose(reports, needs, met=_meets_or_missing)),
    ("IGNORES_MISSING", lambda reports, needs: choose(reports, needs, met=_meets_or_lacks)),
    ("IGNORES_MISSING", lambda reports, needs: choose(reports, needs, met=_meets_or_none)),
    ("IGNORES_MISSING", lambda reports, needs: choose(reports, needs, met=_missing_is_zero)),
    ("STRICT_COMPARISON", lambda reports, needs: choose(reports, needs, met=_strictly)),
    ("COST_REVERSED", lambda reports, needs: choose(reports, needs, cost=-1.0)),
    ("COST_IGNORED", lambda reports, needs: choose(reports, needs, cost=0.0)),
    ("ANY_INSTEAD_OF_ALL", lambda reports, needs: choose(reports, needs, enough=any)),
    ("ANY_INSTEAD_OF_ALL", _most_met),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_reversed)),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_always("<="))),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_always(">="))),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_always("=="))),
]


def of_choices(everything: list[tuple[Any, Any]]) -> Any:
    """The slip that would have given every one of the answers, or the likeliest from the wrong ones."""
    # Only one answer was looked at so far: the others may be anything, and "" is nobody's name.
    everything = [(asked, a if a is None or isinstance(a, str) else "") for asked, a in everything]
    if all(answer is None for _, answer in everything):
        return diagnosis.named("NEVER_CHOOSES")
    for code, slip in SLIPS:
        if all(slip(reports, needs) == answer for (reports, needs, _), answer in everything):
            return diagnosis.named(code)
    wrong = [(question, answer) for question, answer in everything if question[2] != answer]
    for (reports, needs, expected), answer in wrong:
        if answer in reports and all(meets(reports[answer], need) for need in needs):
            return diagnosis.named("COST_IGNORED")
        if expected is None:
            return diagnosis.named("NOTHING_FITS")
    return None

"""Judging ``choose_engine``: what it chose, and which slip would have chosen that."""

from __future__ import annotations

import copy
import operator
from typing import Any

from course.grading import kit

diagnosis = kit.companion("engine-comparison", "diagnosis")
boxes = kit.companion("engine-comparison", "boxes")

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
                diagnose=lambda: of_choices(submission, everything),
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


def _last(reports: Any, needs: Any) -> Any:
    return choose(dict(reversed(reports.items())), needs, cost=0.0)


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
    ("COST_IGNORED", _last),
    ("ANY_INSTEAD_OF_ALL", lambda reports, needs: choose(reports, needs, enough=any)),
    ("ANY_INSTEAD_OF_ALL", _most_met),
    ("FIRST_REQUIREMENT_ONLY", lambda reports, needs: choose(reports, needs[:1])),
    ("FIRST_REQUIREMENT_ONLY", lambda reports, needs: choose(reports, needs[-1:])),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_reversed)),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_always("<="))),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_always(">="))),
    ("OPERATOR_CONFUSED", lambda reports, needs: choose(reports, needs, met=_always("=="))),
]


def expect_untouched(submission: Any, reports: Any, needs: Any) -> None:
    """A call leaves reports and requirements as they were."""
    given = [copy.deepcopy(reports), copy.deepcopy(needs)]
    inspected = submission.call_inspect(TASK, reports, needs)
    # As text: what came back may hold anything, and not everything can be compared.
    if repr([*inspected.args_after]) != repr(given):
        kit.fail(
            "The call changed the reports or the requirements it was given.",
            diagnose=diagnosis.named("MUTATES_INPUT"),
            input={"reports": given[0], "requirements": given[1]},
            actual=inspected.args_after,
        )


# -- which slip it was ------------------------------------------------------------------------------------

#: Names that mean something to whoever reads names, and names that mean nothing, of the same engines.
_TELLING = ("mujoco, well set", "ode, as it comes", "bullet, well set", "physx, as it comes", "balsa")
_MEANINGLESS = ("kifo", "zaru", "melo", "tuba", "nori")


def probing_questions(names: tuple[str, ...]) -> list[tuple[Any, Any]]:
    """Questions (reports, requirements) on which every slip answers in its own way."""
    anvil, balsa, cork = (boxes.TRUTH[name] for name in ("anvil", "balsa", "cork"))
    engines = [
        {**cork, "cost": 7.0, "noise_db": None},
        {**anvil, "cost": 8.0, "noise_db": 60.0},
        {**balsa, "cost": 1.0},
        {**anvil, "cost": 5.0, "order": None, "noise_db": 70.0},
        {**cork, "cost": 9.0, "noise_db": 55.0},
    ]
    reports = dict(zip(names, engines, strict=True))

    def need(key: str, op: str, value: Any) -> dict[str, Any]:
        return {"key": key, "op": op, "value": value}

    asked = [
        [],
        [need("order", ">=", 2)],
        [need("order", "<=", 2), need("symplectic", "==", True)],
        [need("noise_db", "<=", 60.0)],
        [need("noise_db", ">=", 55.0), need("order", "==", 4)],
        [need("restitution", "<=", 0.6), need("restitution", ">=", 0.6)],
        [need("linear_damping", "<=", 1.0), need("noise_db", ">=", 58.0), need("order", ">=", 1)],
        [need("order", ">=", 3), need("symplectic", "==", True)],
        [need("deterministic", "==", False), need("max_stable_step", "<=", 0.6)],
    ]
    return [(copy.deepcopy(reports), needs) for needs in asked]


def of_choices(submission: Any, everything: list[tuple[Any, Any]]) -> Any:
    """The slip that explains every one of the answers, and those to some questions more."""
    evidence = [(asked[:2], _named_or_nothing(answer)) for asked, answer in everything]
    answers = {names: _ask(submission, probing_questions(names)) for names in (_TELLING, _MEANINGLESS)}
    if None not in answers.values():
        places = [[names.index(a) if a in names else a for a in found] for names, found in answers.items()]
        if places[0] != places[1]:
            return diagnosis.named("DEPENDS_ON_NAMES")
        evidence += zip(probing_questions(_MEANINGLESS), answers[_MEANINGLESS], strict=True)
    code = _slip(evidence)
    if code is None:
        reordered = _depends_on_order(submission, answers[_MEANINGLESS])
        code = "DEPENDS_ON_ORDER" if reordered else next(filter(None, map(_of_one, evidence)), None)
    return diagnosis.named(code) if code else None


def _slip(evidence: list[tuple[Any, Any]]) -> str | None:
    """The slip that gives every answer."""
    if all(answer is None for _, answer in evidence):
        return "NEVER_CHOOSES"
    return next(
        (code for code, slip in SLIPS if all(slip(*asked) == answer for asked, answer in evidence)), None
    )


def _of_one(seen: tuple[Any, Any]) -> str | None:
    """What a single answer shows to be wrong."""
    (reports, needs), answer = seen
    right = choose(reports, needs)
    if answer in reports and answer != right and all(meets(reports[answer], need) for need in needs):
        return "COST_IGNORED"
    return "NOTHING_FITS" if answer is not None and right is None else None


def _ask(submission: Any, questions: list[tuple[Any, Any]]) -> list[Any] | None:
    """The answers, or None if it fails on one."""
    found = kit.attempt(lambda: submission.call_each(TASK, questions))
    return None if found is None else [_named_or_nothing(answer) for answer in found]


def _named_or_nothing(answer: Any) -> Any:
    """A name or None; "" for anything else, which is nobody's name."""
    return answer if answer is None or isinstance(answer, str) else ""


def _depends_on_order(submission: Any, before: list[Any] | None) -> bool:
    reordered = [
        (dict(reversed(reports.items())), needs) for reports, needs in probing_questions(_MEANINGLESS)
    ]
    after = _ask(submission, reordered)
    return before is not None and after is not None and before != after

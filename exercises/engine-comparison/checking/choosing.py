"""Judging ``choose_engine``: what it chose, and what its choices have in common."""

from __future__ import annotations

import copy
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from course.scoring import kit

if TYPE_CHECKING:
    from collections.abc import Callable

named = kit.words("engine-comparison")

TASK = "choose_engine"


def expect_choices(submission: Any, questions: list[tuple[Any, Any, Any]]) -> None:
    """Each question (reports, requirements, the right name or None) is answered rightly.

    All of them are asked in one round trip.
    """
    answers = _answers(submission, questions)
    everything = list(zip(questions, answers, strict=True))
    for (reports, needs, expected), answer in everything:
        given = _what_decides(reports, needs)
        if answer is not None and not (isinstance(answer, str) and answer in reports):
            kit.fail(
                "choose_engine returns something that is neither one of the names nor None.",
                help="Return one of the keys of `reports`, or None.",
                diagnose=named("NOTHING_FITS" if expected is None else "NOT_A_NAME"),
                input=given,
                expected=expected,
                actual=answer,
            )
        if answer != expected:
            kit.fail(
                "No engine meets every requirement, but one is chosen."
                if expected is None
                else "None is returned, although an engine meets every requirement."
                if answer is None
                else "The chosen engine is not the cheapest that meets every requirement.",
                help="Which engines meet every requirement here, and which of these costs least? Where "
                "nothing is required, all do.",
                diagnose=lambda: _of_choices(submission, questions, answers),
                input=given,
                expected=expected,
                actual=answer,
            )


def _answers(submission: Any, questions: list[tuple[Any, Any, Any]]) -> list[Any]:
    """What it chooses each time.

    Raises:
        CheckFailed: it raises an exception first where a required value is missing or None.
        StudentFailure: it raises one, in the call that was made last.
    """
    try:
        return list(submission.call_each(TASK, [(reports, needs) for reports, needs, _ in questions]))
    except kit.StudentFailure as failure:
        for reports, needs, _ in questions:
            if not kit.attempt(lambda reports=reports, needs=needs: [submission.call(TASK, reports, needs)]):
                if _answers_when_told(submission, reports, needs):
                    _expect_measured(failure, reports, needs)
                submission.call(TASK, reports, needs)  # once more: a finding shows the arguments of the last
                break
        submission.asking = None  # alone, no question raises: there is no call to show
        raise


def _expect_measured(failure: kit.StudentFailure, reports: Any, needs: Any) -> None:
    """An exception is the fault of nothing that is missing in these reports."""
    missing = any(report.get(need["key"]) is None for report in reports.values() for need in needs)
    if missing and failure.type in {"KeyError", "TypeError"}:
        kit.fail(
            "Not every engine was measured in all that is required, and no answer comes.",
            diagnose=named("MISSING_RAISES"),
            input=_what_decides(reports, needs),
            actual=failure.type,
        )


def _answers_when_told(submission: Any, reports: Any, needs: Any) -> bool:
    """Whether an answer comes once every missing value is there."""
    wanted = {need["key"]: need["value"] for need in needs}
    known = {
        name: wanted | {key: value for key, value in report.items() if value is not None}
        for name, report in reports.items()
    }
    return bool(kit.attempt(lambda: [submission.call(TASK, known, needs)]))


def _what_decides(reports: Any, needs: Any) -> dict[str, Any]:
    """The input of a question. Of each report it has the required keys and the cost: the answer depends on
    nothing else. Numbers about one key that differ in their last digits have all of them."""
    keys = [*dict.fromkeys(need["key"] for need in needs), "cost"]
    told = {
        key: _told_apart(
            [report[key] for report in reports.values() if key in report]
            + [need["value"] for need in needs if need["key"] == key]
        )
        for key in keys
    }
    return {
        "requirements": [
            {name: told[need["key"]](value) if name == "value" else value for name, value in need.items()}
            for need in needs
        ],
        "reports, cut to what decides": {
            name: {key: told[key](report[key]) for key in keys if key in report}
            for name, report in reports.items()
        },
    }


def _told_apart(values: list[Any]) -> Callable[[Any], Any]:
    """How to show each of these values: as it is, or with all its digits where another one that is not equal
    has the same six."""
    alike: dict[str, set[Any]] = {}
    for value in filter(_is_number, values):
        alike.setdefault(f"{value:.6g}", set()).add(value)
    close = {text for text, found in alike.items() if len(found) > 1}
    return lambda value: _in_full(value) if _is_number(value) and f"{value:.6g}" in close else value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _in_full(value: float) -> str:
    return str(value if isinstance(value, int) else float(value))


def expect_untouched(submission: Any, reports: Any, needs: Any) -> None:
    """A call leaves reports and requirements as they were, where something is missing, too."""
    reports = {**reports, "void": {"cost": 0.5, **dict.fromkeys(n["key"] for n in needs[1:])}}
    given = [copy.deepcopy(reports), copy.deepcopy(needs)]
    try:
        inspected = submission.call_inspect(TASK, reports, needs)
    except kit.StudentFailure as failure:
        _expect_measured(failure, reports, needs)
        raise
    # As text: what came back may hold anything, and not everything can be compared.
    if repr([*inspected.args_after]) != repr(given):
        kit.fail(
            "The reports or the requirements were changed by the call.",
            diagnose=named("MUTATES_INPUT"),
            input={"reports": given[0], "requirements": given[1]},
            actual=inspected.args_after,
        )


def _of_choices(submission: Any, questions: list[tuple[Any, Any, Any]], answers: list[Any]) -> Any:
    """Whether the choices follow chance, the names or the order, rather than what was measured."""
    wrong = [(q, answer) for q, answer in zip(questions, answers, strict=True) if answer != q[2]]
    if any(_follows_what_was_asked(submission, reports, needs) for (reports, needs, _), _ in wrong[:3]):
        return named("ANSWERS_VARY")
    others = (
        *[("ANSWERS_VARY", lambda reports, needs: ((reports, needs), {}))] * 2,
        ("DEPENDS_ON_NAMES", _renamed),
        ("DEPENDS_ON_NAMES", _with_known_names),
        ("DEPENDS_ON_ORDER", _reversed),
    )
    for code, other in others:
        told = [other(reports, needs) for reports, needs, _ in questions]
        found = kit.attempt(lambda told=told: submission.call_each(TASK, [asked for asked, _ in told]))
        if found is None:
            return None
        # An answer that is no name at all stands for itself. Of engines that cost the same and of which one
        # is wrongly taken to fit, any rule picks by the order.
        if any(
            _back(now, names) != _back(before, {}) and (code != "DEPENDS_ON_ORDER" or _prices_differ(reports))
            for now, (_, names), before, (reports, _, _) in zip(found, told, answers, questions, strict=True)
        ):
            return named(code)
    if all(answer is None for answer in answers) and _never_chooses(submission):
        return named("NEVER_CHOOSES")
    if code := _of_one_requirement(submission):
        return named(code)
    return named("NOTHING_FITS") if all(expected is None for (_, _, expected), _ in wrong) else None


def _prices_differ(reports: Any) -> bool:
    return len({report["cost"] for report in reports.values()}) == len(reports)


def _follows_what_was_asked(submission: Any, reports: Any, needs: Any) -> bool:
    """Whether a question is answered otherwise after one with the same names and other reports.

    Every name is new, so that only the question before it differs; three times each, since chance may decide.
    """
    passed = dict(zip(reports, [*reports.values()][1:] + [*reports.values()][:1], strict=True))
    found = []
    for marks, before in ((("la", "le", "li"), []), (("na", "ne", "ni"), [passed])):
        for mark in marks:
            other = {name: f"{mark}{number}" for number, name in enumerate(reports)}
            told = [_called(asked, needs, other) for asked in [*before, reports]]
            answers = kit.attempt(lambda told=told: submission.call_each(TASK, [asked for asked, _ in told]))
            if answers is None:
                return False
            found.append(_back(answers[-1], told[-1][1]))
    return len(set(found[:3])) == len(set(found[3:])) == 1 and found[0] != found[3]


def _of_one_requirement(submission: Any) -> str:
    """What a single engine shows that is chosen, or is not, by a single requirement; "" if nothing."""
    known = [{"cost": 1.0, **has} for has in ({}, {"limit": None}, *({"limit": at} for at in _AT.tolist()))]
    told = [({"kifo": one}, [{"key": "limit", "op": op, "value": 5.0}]) for op in _OPERATORS for one in known]
    found = kit.attempt(lambda: [answer == "kifo" for answer in submission.call_each(TASK, told)])
    if found is None:
        return ""
    chosen = np.array(found).reshape(len(_OPERATORS), -1)  # by operator, and by what the engine has
    missing, known = chosen[:, :2], chosen[:, 2:]
    wrong = known & ~np.array([op(_AT, 5.0) for op in _OPERATORS.values()])
    far = np.any(wrong[:, [0, -1]], axis=1)
    close = np.any(wrong[:, 1:-1], axis=1)
    seen = {
        "IGNORES_MISSING": np.any(missing),
        "OPERATOR_IGNORED": np.any(np.all(known, axis=1)),
        "OPERATOR_NEVER_MET": np.any(~np.any(known, axis=1)),
        "STRICT_COMPARISON": not np.all(known[:, len(_AT) // 2]),
        "EQUALITY_ROUGH": np.any(close & ~far),
    }
    return next((code for code, there in seen.items() if there), "")


#: What an engine has, where 5 is the limit: far below, hardly below, equal, hardly above, far above.
_HARDLY = 5 * np.array([1e-2, 1e-7, 1e-11, 1e-15])
_AT = np.array([1.0, *(5 - _HARDLY), 5.0, *(5 + _HARDLY[::-1]), 9.0])
_OPERATORS = {"<=": np.less_equal, ">=": np.greater_equal, "==": np.equal}


def _never_chooses(submission: Any) -> bool:
    """Whether nothing is chosen either where both of two engines fit, by each operator and without any."""
    reports = {"kifo": {"order": 2, "cost": 1.0}, "zaru": {"order": 2, "cost": 2.0}}
    needs = [[{"key": "order", "op": op, "value": 2}] for op in ("<=", ">=", "==")]
    told = kit.attempt(lambda: submission.call_each(TASK, [(reports, need) for need in ([], *needs)]))
    return told is not None and all(answer is None for answer in told)


def _back(answer: Any, names: dict[str, str]) -> str:
    return names.get(answer, answer) if isinstance(answer, str) else repr(answer)


def _renamed(reports: Any, needs: Any) -> tuple[tuple[Any, Any], dict[str, str]]:
    """The same question under names that mean nothing and sort the other way round; which was which."""
    backwards = {name: i for i, name in enumerate(sorted(reports, reverse=True))}
    return _called(reports, needs, {name: f"{chr(ord('b') + backwards[name])}ifo" for name in reports})


def _with_known_names(reports: Any, needs: Any) -> tuple[tuple[Any, Any], dict[str, str]]:
    """The same question under names that mean something to a program that reads them."""
    known = itertools.product(("mujoco", "ode", "bullet", "physx"), ("well set", "as it comes", "", "again"))
    return _called(reports, needs, {name: ", ".join(words) for name, words in zip(reports, known)})  # noqa: B905


def _called(reports: Any, needs: Any, other: dict[str, str]) -> tuple[tuple[Any, Any], dict[str, str]]:
    return ({other[name]: report for name, report in reports.items()}, needs), {
        new: name for name, new in other.items()
    }


def _reversed(reports: Any, needs: Any) -> tuple[tuple[Any, Any], dict[str, str]]:
    return (dict(reversed(reports.items())), needs), {}

"""What is kept of a verdict, and what of it a student may read."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from course.scoring.verdict import MAX_VERDICT, CheckResult, Status, Verdict, Visibility, bounded, for_student


def _check(**fields: Any) -> CheckResult:
    given: dict[str, Any] = {
        "id": "a", "title": "It is so", "task": "integrate", "status": Status.FAIL, "points": 0.0,
        "max_points": 1.0, "visibility": Visibility.HIDDEN, "message": "It is not.", "help": "Do.",
        "diagnosis": "NOT_SO", "duration_ms": 123.4, "actual": 5.0, "quantity": "slip", "stdout": "printed",
        "traceback": "a.py:1 in f",
    }  # fmt: skip
    return CheckResult(**{**given, **fields})


def _verdict(*checks: CheckResult) -> Verdict:
    return Verdict(
        exercise="e",
        scope="full",
        state="graded",
        score=0.0,
        max_score=1.0,
        passed=False,
        checks=checks,
        isolation="L3",
    )


def test_a_hidden_check_that_looked_keeps_its_words_and_nothing_else() -> None:
    seen = for_student(_check())
    assert (seen.status, seen.message, seen.help, seen.diagnosis) == ("fail", "It is not.", "Do.", "NOT_SO")
    assert (seen.actual, seen.stdout, seen.traceback, seen.duration_ms) == (None, None, None, 0.0)
    assert seen.quantity == ""
    public = _check(visibility=Visibility.PUBLIC)
    assert for_student(public) is public


@pytest.mark.parametrize(
    ("status", "said", "told"),
    [
        (Status.ERROR, "RAISED", "RAISED"),
        (Status.ERROR, "NOT_IMPLEMENTED", "RAISED"),
        (Status.ERROR, "IMPORT_NOT_ALLOWED", "RAISED"),
        (Status.TIMEOUT, "TIMEOUT", "TIMEOUT"),
        (Status.MEMORY, "OUT_OF_MEMORY", "OUT_OF_MEMORY"),
        (Status.CRASH, "CRASHED", "CRASHED"),
        (Status.ERROR, "NOT_PLAIN_DATA", "OTHER_FORM"),
        (Status.CRASH, "NOT_PLAIN_DATA", "OTHER_FORM"),
        (Status.FAIL, "WRONG_KEYS", "OTHER_FORM"),
        (Status.FAIL, "WRONG_SHAPE", "OTHER_FORM"),
        (Status.FAIL, "RETURNS_NOTHING", "OTHER_FORM"),
    ],
)
def test_without_a_value_one_of_five_things_is_said_of_a_hidden_check(
    status: Status, said: str, told: str
) -> None:
    results = [
        for_student(
            _check(status=status, diagnosis=said, message=f"ValueError on line {line}.", help=str(line))
        )
        for line in (7, 8)
    ]
    assert results[0] == results[1]
    assert results[0].diagnosis == told
    assert "`integrate`" in results[0].message


def test_a_function_that_is_not_there_is_told_as_such() -> None:
    """It was known before any input was."""
    missing = _check(
        status=Status.ERROR, diagnosis="MISSING_FUNCTION", message="Your file has no function `f`."
    )
    assert for_student(missing).message == missing.message


def test_a_verdict_has_its_bound_whatever_is_in_it() -> None:
    long = {"stdout": "\U0001f600" * 4000, "traceback": "\\" * 9000, "actual": ["x" * 200] * 20}
    small, large = _verdict(_check()), _verdict(*[_check(**long)] * 40)
    assert bounded(small) is small
    assert len(msgspec.json.encode(large)) > MAX_VERDICT
    kept = bounded(large)
    assert len(msgspec.json.encode(kept)) <= MAX_VERDICT
    assert [(check.status, check.message) for check in kept.checks] == [("fail", "It is not.")] * 40
    assert kept.checks[0].actual == large.checks[0].actual, "what is needed most goes last"

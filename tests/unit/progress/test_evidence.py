"""Which numbers of a failed check a hint may use, and how they are written."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from course.handed_in.attempts import Attempt, numbers_of
from course.progress.history import history_of
from course.progress.store import Event
from course.scoring.verdict import CheckResult, Status, Verdict, Visibility

NOW = datetime(2025, 1, 1, tzinfo=UTC)


def failed(expected=None, actual=None, **fields):
    usual = {
        "id": "reach", "title": "", "task": "throw", "status": Status.FAIL, "visibility": Visibility.PUBLIC,
        "points": 0.0, "max_points": 1.0, "expected": expected, "actual": actual,
    }  # fmt: skip
    return CheckResult(**(usual | fields))


def recorded(*checks):
    """What ``course check`` writes down."""
    verdict = Verdict(
        exercise="throwing", scope="public", state="graded", score=0.0, max_score=1.0, passed=False,
        checks=checks, isolation="L1",
    )  # fmt: skip
    return Attempt(None, b"", verdict, 0.1).data("1")


@pytest.mark.parametrize(
    ("expected", "got", "fields"),
    [
        (4.5, 3.75, {"expected": "4.5", "got": "3.75", "off": "-0.75", "ratio": "0.8333"}),
        (2.0, 2.00000001, {"expected": "2", "got": "2.00000001", "off": "+1e-08"}),
        (30, 29, {"expected": "30", "got": "29", "off": "-1", "ratio": "0.9667"}),
        (0.0, 1.0, {"expected": "0", "got": "1", "off": "+1"}),
        (2.0, -0.0, {"expected": "2", "got": "0", "off": "-2"}),
        (1.0, float("inf"), {"expected": "1", "got": "inf"}),
        (True, False, {"expected": "True", "got": "False"}),
        ([1.0, 2], [1.0, 3], {"expected": "[1, 2]", "got": "[1, 3]"}),
        (
            {"q[2]": 0.5},
            {"q[2]": 1.0},
            {"expected": "0.5", "got": "1", "off": "+0.5", "ratio": "2", "at": "q[2]"},
        ),
        ({"at most": 0.03}, 2.0, {"expected": "at most 0.03", "got": "2"}),
        (None, 3.0, {"got": "3"}),
        (3.0, None, {"expected": "3"}),
        (list(range(9)), 1, {"got": "1"}),
        ("a result", "ValueError: " + 40 * "x", {"expected": "a result"}),
        (1, 10**400, {"expected": "1"}),
        (None, None, {}),
    ],
)
def test_values_are_written_for_a_sentence_or_left_out(expected, got, fields):
    assert numbers_of(failed(expected, got)) == fields


def test_inputs_are_fields_by_their_names():
    given = {"h": 1 / 30, "q0": [1e7, 1e7 + 0.3], "path": list(range(50))}
    found = numbers_of(failed(2.0, 1.0, input=given))
    assert found == {
        "h": "0.03333",
        "q0": "[10000000, 10000000.3]",
        "expected": "2",
        "got": "1",
        "off": "-1",
        "ratio": "0.5",
    }


@pytest.mark.parametrize("other", [{"visibility": Visibility.HIDDEN}, {"status": Status.PASS}])
def test_nothing_is_told_of_a_hidden_check_or_of_one_that_passed(other):
    check = failed(2.0, 1.0, input={"h": 0.05}, **other)
    assert numbers_of(check) == {}
    assert "numbers" not in recorded(check)["checks"][0]


def test_the_record_gives_them_back_with_the_diagnosis():
    data = recorded(failed(2.0, 1.0, diagnosis="HALVED"), failed(1, 2, id="other", task="catch"))
    history = history_of([Event(id=1, at=NOW, kind="check", subject="throwing", data=data)])
    assert history.diagnosed("throw") == (
        ("HALVED", {"expected": "2", "got": "1", "off": "-1", "ratio": "0.5"}),
    )


@pytest.mark.parametrize("odd", ["abc", 3, None, [1]])
def test_a_record_that_somebody_changed_has_no_numbers(odd):
    data = recorded(failed(2.0, 1.0))
    data["checks"][0]["numbers"] = odd
    history = history_of([Event(id=1, at=NOW, kind="check", subject="throwing", data=data)])
    assert history.diagnosed("throw") == (("", {}),)

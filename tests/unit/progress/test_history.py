"""What the events of an exercise add up to: above all, when a hint is due."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from course.progress.history import fingerprint, history_of
from course.progress.store import Event

STUB = fingerprint(b"def double(x):\n    raise NotImplementedError\n")
FIRST = fingerprint(b"def double(x):\n    return x\n")
SECOND = fingerprint(b"def double(x):\n    return 3 * x\n")


def _history(*events):
    now = datetime(2025, 1, 1, tzinfo=UTC)
    return history_of(
        Event(id=number, at=now, kind=kind, subject="doubling", data=data)
        for number, (kind, data) in enumerate(events, start=1)
    )


def _check(code, status="fail", **fields):
    score = 2.0 if status == "pass" else 0.0
    checks = [{"id": "double_of_three", "task": "double", "status": status}]
    data = {"state": "graded", "score": score, "max_score": 2.0, "passed": status == "pass"}
    return ("check", {**data, "fingerprint": code, "checks": checks, **fields})


def _hint(code, index=0, task="double"):
    return ("hint", {"task": task, "index": index, "fingerprint": code})


#: What happened -> the events, and whether the next hint is due.
HINTS = {
    "nothing": ([], False),
    "a check of the untouched stub": ([_check(STUB)], False),
    "a failed check of changed code": ([_check(FIRST)], True),
    "a hint, and the same code again": ([_check(FIRST), _hint(FIRST), _check(FIRST)], False),
    "a hint, and code changed since": ([_check(FIRST), _hint(FIRST), _check(SECOND)], True),
    "other code, but before the last hint": ([_check(SECOND), _check(FIRST), _hint(FIRST)], False),
    "a check that passed": ([_check(FIRST, status="pass")], False),
    "a check that passed, and the stub again": ([_check(FIRST, status="pass"), _check(STUB)], False),
    "a file that could not run": ([_check(FIRST, state="ungradable", checks=[])], False),
}


@pytest.mark.parametrize("what", HINTS)
def test_a_hint_is_due_after_a_failed_check_of_code_changed_since_the_last_one(what):
    events, due = HINTS[what]
    history = _history(*events)
    assert history.hint_is_due(STUB) is due
    assert history.hints_for("double") == tuple(data["index"] for kind, data in events if kind == "hint")


def test_failing_tasks_are_those_of_the_newest_whole_run():
    assert _history(_check(FIRST), _check(SECOND, status="pass")).failing_tasks() == frozenset()
    assert _history(_check(FIRST, status="pass"), _check(SECOND)).failing_tasks() == {"double"}


@pytest.mark.parametrize("odd", ["abc", None, [1], float("nan"), {}])
def test_a_number_that_somebody_overwrote_stops_nobody(odd):
    (run,) = _history(_check(FIRST, score=odd, max_score=odd, seconds=odd)).runs
    assert (run.score, run.max_score, run.seconds) == (0.0, 0.0, 0.0)


def test_a_check_run_alone_corrects_the_last_whole_run_and_leaves_its_score():
    history = _history(_check(FIRST), _check(SECOND, status="pass", only="double_of_three"))
    assert history.failing_tasks() == frozenset()
    assert history.last_graded.score == 0.0
    assert history.first_pass is None


@pytest.mark.parametrize(
    "other",
    [
        b"def double(x):\n    return x  # now with a comment\n",
        b"def double(x):\r\n\r\n    return  x\r\n",
        b"\xef\xbb\xbfdef double(x):\n    return x\n",
        b'"""What this is about."""\n\npass\ndef double(x):\n    return x\n',
    ],
)
def test_comments_and_layout_are_no_attempt(other):
    assert fingerprint(other) == FIRST


def test_the_order_of_functions_is_no_attempt_but_any_change_of_one_is():
    other = b"def halve(x):\n    return x / 2\n"
    both = b"def double(x):\n    return x\n"
    assert fingerprint(both + other) == fingerprint(other + both)
    assert fingerprint(both + other) != fingerprint(both)
    assert fingerprint(both + other) != fingerprint(both + other.replace(b"2", b"3"))
    # Of two definitions the last counts, and of two assignments, too.
    assert fingerprint(both + both.replace(b"x\n", b"1\n")) != fingerprint(
        both.replace(b"x\n", b"1\n") + both
    )
    assert fingerprint(b"x = 1\nx = 2\n") != fingerprint(b"x = 2\nx = 1\n")


@pytest.mark.parametrize("source", [b"def double(x:\n", b"\x00", b"\xff\xfe", b"(" * 100_000, b'"\\d"\n'])
def test_a_file_that_does_not_parse_has_a_fingerprint_too(source):
    assert fingerprint(source) != fingerprint(source + b"1\n")


def test_records_with_missing_fields_are_understood():
    history = _history(("check", {}), ("hint", {}), ("start", {}))
    assert history.last.score == 0.0
    assert history.failing_tasks() == frozenset()

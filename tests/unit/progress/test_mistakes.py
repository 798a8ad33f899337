"""Mistakes are read out of runs of checks: first seen, last seen, mended."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from course.progress.history import mistakes_of
from course.progress.store import Event
from tests.unit.progress.test_evidence import failed, recorded

START = datetime(2026, 11, 22, 10, tzinfo=UTC)


def run(minute: int, *checks: tuple[str, str, str | None], subject: str = "integrators") -> Event:
    """(id, status, diagnosis) of each check of one function."""
    results = [
        failed(id=name, task="step", status=status, diagnosis=diagnosis) for name, status, diagnosis in checks
    ]
    return Event(minute, START + timedelta(minutes=minute), "check", subject, recorded(*results))


def test_a_mistake_has_its_first_and_last_run_and_the_one_that_mended_it():
    (one,) = mistakes_of(
        [
            run(1, ("order", "fail", "SWAPPED"), ("energy", "fail", "SWAPPED")),
            run(2, ("order", "fail", "SWAPPED"), ("energy", "pass", None)),
            run(3, ("order", "pass", None), ("energy", "pass", None)),
            run(4, ("order", "pass", None), ("energy", "pass", None)),
        ]
    )
    assert (one.exercise, one.task, one.diagnosis, one.runs) == ("integrators", "step", "SWAPPED", 2)
    minutes = [(at - START).seconds // 60 for at in (one.first, one.last, one.mended)]
    assert minutes == [1, 2, 3]


@pytest.mark.parametrize(
    ("later", "found"),
    [
        ([run(2, ("order", "fail", "SIGN"))], [("SWAPPED", 1), ("SIGN", 1)]),
        ([run(2, ("order", "pass", None)), run(3, ("order", "fail", "SWAPPED"))], [("SWAPPED", 2)]),
        ([run(2, ("order", "pass", None), subject="other")], [("SWAPPED", 1)]),
        ([run(2, ("order", "skip", None))], [("SWAPPED", 1)]),
    ],
    ids=["another failure of its check", "made again", "a check of that name elsewhere", "skipped"],
)
def test_what_mends_no_mistake(later: list[Event], found: list[tuple[str, int]]):
    mistakes = mistakes_of([run(1, ("order", "fail", "SWAPPED")), *later])
    assert [(one.diagnosis, one.runs) for one in mistakes] == found
    assert {one.mended for one in mistakes} == {None}


def test_work_to_do_and_what_follows_from_a_mistake_are_none():
    codes = ("NOT_IMPLEMENTED", "MISSING_FUNCTION", "CALLS_A_WRONG_FUNCTION")
    assert mistakes_of([run(1, *((code, "fail", code) for code in codes))]) == ()

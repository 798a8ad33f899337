"""When a missed question comes back: evenly spaced, and never twice on a day."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.quizzing.desk import GAP_DAYS, ROUNDS, due_after, schedule

START = datetime(2026, 3, 2, 12).astimezone()


def on(days: float, right: bool) -> tuple[datetime, bool]:
    return START + timedelta(days=days), right


@pytest.mark.parametrize(
    ("answers", "due", "rounds"),
    [
        ([on(0, False)], 2, 0),
        ([on(0, False), on(2, True), on(4, True)], 6, 2),
        ([on(0, False), on(0.01, True), on(1, True), on(1.1, True)], 2, 0),
        ([on(0, False), on(2, True), on(3, False)], 5, 0),
        ([on(0, False), on(9, True)], 11, 1),
        # Missed in the evening, it is due from the morning of its day.
        ([on(0.49, False), on(2 - 0.49, True)], 4, 1),
    ],
    ids=["missed", "in time", "before its day", "wrong again", "late", "other times of day"],
)
def test_what_was_missed_is_due_two_days_after_it_counted_last(
    answers: list[tuple[datetime, bool]], due: int, rounds: int
) -> None:
    found = due_after("q", answers)
    assert found is not None
    assert (found.question, found.on, found.rounds) == ("q", START.date() + timedelta(days=due), rounds)


def test_the_soonest_comes_first_and_gone_questions_are_passed_over() -> None:
    outcomes = {"b": [on(1, False)], "a": [on(0, False)], "gone": [on(0, False)], "fine": [on(0, True)]}
    assert [due.question for due in schedule(outcomes, ("b", "a", "fine"))] == ["a", "b"]


@given(st.lists(st.tuples(st.floats(0, 40), st.booleans()), max_size=12))
def test_a_question_is_never_due_sooner_than_the_gap_after_it_was_last_missed(
    entries: list[tuple[float, bool]],
) -> None:
    answers = sorted(on(days, right) for days, right in entries)
    due = due_after("q", answers)
    missed = [at for at, right in answers if not right]
    if not missed:
        assert due is None
    elif due is not None:
        assert due.on >= missed[-1].date() + timedelta(days=GAP_DAYS)
        assert 0 <= due.rounds < ROUNDS
    else:
        after = sum(at > missed[-1] for at, right in answers if right)
        assert after >= ROUNDS

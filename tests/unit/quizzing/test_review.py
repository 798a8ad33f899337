"""When a missed question comes back: evenly spaced, and never twice on a day."""

from __future__ import annotations

from datetime import date, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.quizzing.desk import GAP_DAYS, ROUNDS, due_after, schedule

START = datetime(2026, 3, 2, 12).astimezone()


def on(days: float, right: bool) -> tuple[datetime, bool]:
    return START + timedelta(days=days), right


def day(days: int) -> date:
    return START.date() + timedelta(days=days)


def test_what_was_never_missed_is_not_reviewed() -> None:
    assert due_after("q", []) is None
    assert due_after("q", [on(0, True), on(5, True)]) is None


def test_what_was_missed_is_due_after_two_days() -> None:
    due = due_after("q", [on(0, False)])
    assert due is not None
    assert (due.question, due.on, due.rounds) == ("q", day(2), 0)


def test_the_time_of_day_does_not_matter() -> None:
    """Missed in the evening, it is due from the morning of its day."""
    late = START.replace(hour=23, minute=50)
    due = due_after("q", [(late, False), (late.replace(hour=0, minute=5) + timedelta(days=2), True)])
    assert due is not None
    assert (due.on, due.rounds) == (day(4), 1)


def test_three_right_answers_with_even_gaps_are_enough() -> None:
    answers = [on(0, False), on(2, True), on(4, True)]
    due = due_after("q", answers)
    assert due is not None
    assert (due.on, due.rounds) == (day(6), 2)
    assert due_after("q", [*answers, on(6, True)]) is None


def test_a_right_answer_before_its_day_changes_nothing() -> None:
    due = due_after("q", [on(0, False), on(0.01, True), on(1, True), on(1.1, True)])
    assert due is not None
    assert (due.on, due.rounds) == (day(2), 0)


def test_a_wrong_answer_starts_again_on_whatever_day() -> None:
    due = due_after("q", [on(0, False), on(2, True), on(3, False)])
    assert due is not None
    assert (due.on, due.rounds) == (day(5), 0)


def test_a_late_review_moves_the_next_one() -> None:
    due = due_after("q", [on(0, False), on(9, True)])
    assert due is not None
    assert (due.on, due.rounds) == (day(11), 1)


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


@pytest.mark.parametrize("days", range(1, 8))
def test_practice_every_day_is_counted_every_other_day(days: int) -> None:
    answers = [on(0, False), *(on(number, True) for number in range(1, days + 1))]
    due = due_after("q", answers)
    assert (due is None) == (days >= ROUNDS * GAP_DAYS)

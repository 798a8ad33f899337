"""Predictions of all lessons, counted from what the reader writes."""

from __future__ import annotations

from datetime import UTC, datetime

from course.progress.store import Event
from course.reading.record import predictions_of, tally

AT = datetime(2026, 11, 22, 10, tzinfo=UTC)


def events(*given: tuple[str, dict[str, object]]) -> list[Event]:
    return [Event(number, AT, "prediction", lesson, data) for number, (lesson, data) in enumerate(given, 1)]


def test_what_was_said_first_stays_and_the_last_judgement_counts():
    (said,) = predictions_of(
        events(
            ("a", {"key": "k", "number": 1, "text": "five"}),
            ("a", {"key": "k", "number": 1, "text": "six"}),
            ("a", {"key": "k", "number": 1, "judged": "wrong"}),
            ("a", {"key": "k", "number": 1, "judged": "nearly"}),
            ("a", {"key": "k", "number": 1, "judged": "perfect"}),
        )
    )
    assert (said.text, said.judged) == ("five", "nearly")


def test_the_same_key_in_two_lessons_is_two_questions():
    both = predictions_of(events(("a", {"key": "k", "text": "x"}), ("b", {"key": "k", "text": "y"})))
    assert [one.text for one in both] == ["x", "y"]


def test_a_skipped_prediction_is_neither_said_nor_judged():
    counts = tally(
        predictions_of(
            events(
                ("a", {"key": "1", "text": ""}),
                ("a", {"key": "1", "judged": "right"}),
                ("a", {"key": "2", "text": "x"}),
                ("a", {"key": "3", "text": "y"}),
                ("a", {"key": "3", "judged": "right"}),
            )
        )
    )
    assert counts == {"said": 2, "skipped": 1, "right": 1, "nearly": 0, "wrong": 0, "unjudged": 1}

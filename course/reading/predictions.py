"""A student's predictions in all lessons, and how good they were: read from the reader's record."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from course.reading.record import JUDGEMENTS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from datetime import datetime

    from course.progress.store import Event
    from course.reading.record import Judgement

__all__ = ["RecordedPrediction", "Tally", "predictions_of", "tally"]


@dataclass(frozen=True, slots=True)
class RecordedPrediction:
    """One prediction.

    Attributes:
        lesson: where it was asked.
        key: of the question, as ``Question.key``.
        number: of the question when it was answered, 1 for the first of the lesson.
        text: the prediction; empty if it was skipped.
        at: when, in UTC.
        judged: how it did, by its author's word once the answer was open; None if that was not said.
    """

    lesson: str
    key: str
    number: int
    text: str
    at: datetime
    judged: Judgement | None = None


@dataclass(frozen=True, slots=True)
class Tally:
    """How many of some predictions went which way; ``unjudged`` were made and never judged."""

    right: int = 0
    nearly: int = 0
    wrong: int = 0
    unjudged: int = 0
    skipped: int = 0

    @property
    def said(self) -> int:
        return self.right + self.nearly + self.wrong + self.unjudged


def predictions_of(events: Iterable[Event]) -> tuple[RecordedPrediction, ...]:
    """The predictions that events of kind "prediction" tell of, in the order they were made.

    The first prediction for a question stays, as in the reader; the last judgement counts.
    """
    found: dict[tuple[str, str], RecordedPrediction] = {}
    for event in events:
        if event.kind != "prediction":
            continue
        data, place = event.data, (event.subject, str(event.data.get("key", "")))
        said, judged = found.get(place), data.get("judged")
        if said is None:
            number = data.get("number")
            text = str(data.get("text", ""))
            found[place] = RecordedPrediction(
                *place, number if isinstance(number, int) else 0, text, event.at
            )
        elif judged in JUDGEMENTS and said.text:
            found[place] = replace(said, judged=judged)
    return tuple(found.values())


def tally(predictions: Iterable[RecordedPrediction]) -> Tally:
    """Count them."""
    counts = dict.fromkeys(Tally.__dataclass_fields__, 0)
    for one in predictions:
        counts["skipped" if not one.text else one.judged or "unjudged"] += 1
    return Tally(**counts)

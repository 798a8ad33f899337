"""The scores that a decision about the class changed, and by how much; stored with the decision."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from course.grading.gradebook.records import Decision
from course.grading.results.effective import Results

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.grading.gradebook.book import Gradebook

__all__ = ["Recording", "ScoreChange", "counting", "recorded"]

Scores = dict[tuple[str, str], float | None]


class ScoreChange(msgspec.Struct, frozen=True):
    """A change of the score that counts; None where there is no score."""

    student: str
    exercise: str
    before: float | None
    after: float | None


@dataclass
class Recording:
    """The scores that a decision changed, once it is made."""

    moved: list[ScoreChange] = field(default_factory=list)


def counting(results: Results) -> Scores:
    """The effective scores, by student and exercise."""
    return {(item.student, item.exercise): item.score for item in results.all()}


@contextlib.contextmanager
def recorded(book: Gradebook, kind: str, reason: str) -> Iterator[Recording]:
    """Record which scores the decision in this block changed.

    Args:
        kind: as in ``Decision``.
    """
    told = Recording()
    before = counting(Results(book))
    yield told
    after = counting(Results(book))
    told.moved = [
        ScoreChange(*key, before.get(key), after.get(key))
        for key in sorted({*before, *after})
        if before.get(key) != after.get(key)
    ]
    old = [(one.student, one.exercise, one.before) for one in told.moved]
    new = [(one.student, one.exercise, one.after) for one in told.moved]
    texts = (msgspec.json.encode(old).decode(), msgspec.json.encode(new).decode())
    book.note(Decision("", "", kind, "", "", reason, *texts))

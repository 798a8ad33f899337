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
    from course.grading.gradebook.records import Key
    from course.grading.results.effective import Effective

__all__ = ["Recording", "ScoreChange", "counted", "counting", "moved", "recorded", "replacing"]

#: By student and exercise: the score that counts, and the points there are.
Scores = dict[tuple[str, str], tuple[float | None, float | None]]
_NONE = (None, None)


class ScoreChange(msgspec.Struct, frozen=True):
    """A change of the score that counts, and of the points there are; None where there is no score."""

    student: str
    exercise: str
    before: float | None
    after: float | None
    max_before: float | None = None
    max_after: float | None = None


@dataclass
class Recording:
    """The scores that a decision changed, once it is made."""

    moved: list[ScoreChange] = field(default_factory=list)


def counting(results: Results) -> Scores:
    """The effective scores."""
    return {(item.student, item.exercise): (item.score, item.max_score) for item in results.all()}


def moved(before: Scores, after: Scores) -> list[ScoreChange]:
    """The scores that are not the same, by student."""
    return [
        ScoreChange(*key, was, now, most_before, most_after)
        for key in sorted({*before, *after})
        for (was, most_before), (now, most_after) in [(before.get(key, _NONE), after.get(key, _NONE))]
        if was != now
    ]


@contextlib.contextmanager
def recorded(book: Gradebook, kind: str, reason: str) -> Iterator[Recording]:
    """Record which scores the decision in this block changed.

    Args:
        kind: as in ``Decision``.
    """
    told = Recording()
    before = counting(Results(book))
    yield told
    told.moved = moved(before, counting(Results(book)))
    old = [(one.student, one.exercise, one.before) for one in told.moved]
    new = [(one.student, one.exercise, one.after) for one in told.moved]
    texts = (msgspec.json.encode(old).decode(), msgspec.json.encode(new).decode())
    book.note(Decision("", "", kind, "", "", reason, *texts))


@contextlib.contextmanager
def replacing(book: Gradebook, view: Results, key: Key) -> Iterator[None]:
    """Note in the journal if the result that this block puts in the place of another changes what counts."""
    before = next(view.all(key.student, key.exercise), None)
    yield
    after = next(view.all(key.student, key.exercise), None)
    if before is None or after is None or before.waiting:
        return  # it is the first
    if (before.verdict.state, before.score) != (after.verdict.state, after.score):
        told = counted(before), counted(after)
        book.note(Decision("", "", "resume", key.student, key.exercise, "another submission", *told))


def counted(counts: Effective | None, file: str = "") -> str:
    """What counts for a student's exercise, as a decision about it keeps it.

    Args:
        file: the file that the instructor chose, if any.
    """
    if counts is None:
        return msgspec.json.encode({"state": "missing", "score": None}).decode()
    told: dict[str, object] = {"state": counts.verdict.state, "score": counts.score, "of": counts.max_score}
    told |= {"submission": counts.result.key.submission_sha256}
    if counts.verdict.error is not None:
        told["reason"] = counts.verdict.error.code
    return msgspec.json.encode(told | ({"file": file} if file else {})).decode()

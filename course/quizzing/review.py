"""When a missed question comes back.

Spaced practice beats massed practice, and evenly spaced is as good as any schedule and the easiest to keep:
a question that was missed is due every ``GAP_DAYS`` days until it was answered rightly ``ROUNDS`` times in
a row. A wrong answer starts the count again. An answer before the day it was due changes nothing when it is
right: repeating something while it is fresh is the massed practice that this is to avoid.

Source: Latimier, Peyre, Ramus 2021, Educational Psychology Review 33 (a meta-analysis of spaced retrieval:
0.74 against massed; no difference found between expanding and uniform spacing).
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, timedelta
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from datetime import datetime

__all__ = ["GAP_DAYS", "ROUNDS", "Due", "due_after", "schedule"]

GAP_DAYS = 2
ROUNDS = 3


@dataclass(frozen=True, slots=True)
class Due:
    """A question under review.

    Attributes:
        on: the day it is due, in the student's own time zone.
        rounds: right answers in a row, each on or after its day.
    """

    question: str
    on: date
    rounds: int


def schedule(
    outcomes: Mapping[str, Iterable[tuple[datetime, bool]]], known: Iterable[str]
) -> tuple[Due, ...]:
    """The questions under review, soonest first.

    Args:
        outcomes: by question id, when it was answered and whether rightly, oldest first.
        known: ids of the questions there are, in their order; others have gone from the quiz.
    """
    found = (due_after(name, outcomes[name]) for name in known if name in outcomes)
    return tuple(sorted((due for due in found if due is not None), key=lambda due: due.on))


def due_after(question: str, outcomes: Iterable[tuple[datetime, bool]]) -> Due | None:
    """The state of one question; None if it was never missed, or was brought back often enough."""
    due: Due | None = None
    for at, right in outcomes:
        day = at.astimezone().date()
        following = day + timedelta(days=GAP_DAYS)
        if not right:
            due = Due(question, following, 0)
        elif due is not None and day >= due.on:
            due = Due(question, following, due.rounds + 1) if due.rounds + 1 < ROUNDS else None
    return due

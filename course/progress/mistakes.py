"""Which mistakes a student made, and when each was mended, from the recorded checks.

A mistake is a diagnosis of one function. It is mended when every check that showed it has passed since;
checks that now fail for another reason do not mend it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable
    from datetime import datetime

    from course.progress.store import Event

__all__ = ["NO_MISTAKE", "Mistake", "mistakes_of"]

#: Diagnoses that are not mistakes of their own: unwritten work, and consequences of another mistake.
NO_MISTAKE = frozenset({"NOT_IMPLEMENTED", "MISSING_FUNCTION", "MEASURED_AS_NONE", "CALLS_A_WRONG_FUNCTION"})


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake in one function.

    Attributes:
        exercise, task: where.
        diagnosis: its code.
        first, last: the first and the last run that showed it, in UTC.
        runs: how many runs showed it.
        raised: the exception that the last of them ended in; "" if it was none.
        mended: the run after which every check that showed it had passed; None while one has not.
    """

    exercise: str
    task: str
    diagnosis: str
    first: datetime
    last: datetime
    runs: int
    mended: datetime | None
    raised: str = ""


@dataclass(slots=True)
class _Open:
    first: datetime
    last: datetime
    runs: int = 0
    checks: set[str] = field(default_factory=set)
    mended: datetime | None = None
    raised: str = ""


def mistakes_of(events: Iterable[Event]) -> tuple[Mistake, ...]:
    """The mistakes that events of kind "check" tell of, in the order they were first made.

    Runs that were recorded before diagnoses were kept tell of none.
    """
    found: dict[tuple[str, str, str], _Open] = {}
    for event in events:
        if event.kind == "check" and event.data.get("state") == "graded":
            _take(found, event)
    return tuple(
        Mistake(*key, one.first, one.last, one.runs, one.mended, one.raised) for key, one in found.items()
    )


def _take(found: dict[tuple[str, str, str], _Open], event: Event) -> None:
    checks = [check for check in event.data.get("checks", ()) if isinstance(check, dict)]
    shown: dict[tuple[str, str, str], set[str]] = {}
    raised: dict[tuple[str, str, str], str] = {}
    for check in checks:
        code = check.get("diagnosis")
        if isinstance(code, str) and code not in NO_MISTAKE:
            key = (event.subject, str(check.get("task")), code)
            shown.setdefault(key, set()).add(str(check.get("id")))
            raised.setdefault(key, str(check.get("raised", "")))
    for key, ids in shown.items():
        one = found.setdefault(key, _Open(event.at, event.at))
        one.last, one.mended = event.at, None
        one.runs += 1
        one.raised = raised[key]
        one.checks |= ids
    passed = {str(check.get("id")) for check in checks if check.get("status") == "pass"}
    for (exercise, _, _), one in found.items():
        if exercise == event.subject and one.checks:
            one.checks -= passed
            if not one.checks:
                one.mended = event.at

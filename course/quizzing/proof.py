"""Goes through every case of a question, for faults that reading its file cannot show.

A variant draws its numbers from finite lists, so "no seed ever shows two options that are the same" is not
a matter of sampling: each case is posed once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.errors import ContentError
from course.quizzing.bank import clashing, pose_case

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.catalog.questions import Question
    from course.catalog.reading import Document

__all__ = ["Fault", "faults_in"]


@dataclass(frozen=True, slots=True)
class Fault:
    """Something wrong with a question, and the line to look at."""

    line: int | None
    message: str
    fix: str


def faults_in(document: Document[Question]) -> Iterator[Fault]:
    """The first fault of each variant: a formula without a value, or options that cannot be told apart."""
    for index, variant in enumerate(document.value.variant):
        for case in range(variant.cases):
            fault = _fault(document, index, case)
            if fault is not None:
                yield fault
                break


def _fault(document: Document[Question], index: int, case: int) -> Fault | None:
    try:
        posed = pose_case(document, index, case)
    except ContentError as error:
        return Fault(error.line, error.problem, error.help)
    clash = clashing(posed.choices)
    if clash is None:
        return None
    one, other = (posed.choices[place] for place in clash)
    return Fault(
        document.lines.line(("variant", index, "option", clash[1], "text")),
        f"variant {posed.variant}: option {other.id} reads {other.text!r}, and option {one.id} reads "
        f"{one.text!r}; these numbers are too close to tell apart.",
        "Change a formula, or the values it is computed from, so that options differ by more than 2 %.",
    )

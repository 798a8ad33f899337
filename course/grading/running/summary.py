"""A grading run in numbers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from course.scoring.failures import OURS

if TYPE_CHECKING:
    from course.grading.results.effective import Results
    from course.grading.results.journal import ScoreChange
    from course.grading.results.merge import Merged
    from course.grading.results.roster import Roster

__all__ = ["Summary", "Ungraded"]


class Ungraded(msgspec.Struct, frozen=True):
    """One submission without a grade."""

    student: str
    exercise: str
    state: str
    code: str
    message: str


@dataclass
class Summary:
    """The numbers of a run.

    Attributes:
        states: number of results by state.
        troubled: the results without a grade.
        not_submitted: pairs without a file, which count for nothing.
        already: results of an earlier run.
        missing: students who handed in nothing at all: enrolled, or without a roster those with a folder.
        strangers: students who handed in something and have no row of their own in the roster.
        compared: the columns of the roster in which these were looked for, as sentences.
        unrecognised: files in the class folder with an unknown owner, one sentence each.
        moved: scores that a second roster changed.
        dropped: students of the earlier roster that it does not have.
        unjudged: how often a check broke on a submission's result: (exercise, check, where).
        graders: digest of the snapshot that judged.
        pass_marks: of the exercises with results: the points that pass, and all points.
        unsettled: entries that could not be graded and have no score by hand.
        edited: exercises scored by other graders than the present ones: a resumed run keeps its own.
        elapsed_s: wall seconds.
        write_s: of these, spent on writing the gradebook.
    """

    states: Counter[str] = field(default_factory=Counter)
    passed: int = 0
    troubled: list[Ungraded] = field(default_factory=list)
    not_submitted: int = 0
    missing: list[str] = field(default_factory=list)
    strangers: list[str] = field(default_factory=list)
    compared: str = ""
    already: int = 0
    levels: Counter[str] = field(default_factory=Counter)
    unrecognised: list[str] = field(default_factory=list)
    moved: list[ScoreChange] = field(default_factory=list)
    dropped: list[str] = field(default_factory=list)
    unjudged: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    graders: str = ""
    pass_marks: list[tuple[float, float]] = field(default_factory=list)
    unsettled: int = 0
    edited: list[str] = field(default_factory=list)
    seed: int = 0
    elapsed_s: float = 0.0
    write_s: float = 0.0

    @property
    def exit_code(self) -> int:
        """70 if any fault was ours, 6 if anything could not be graded, else 0 whatever the scores."""
        if self.states["grader_error"]:
            return 70
        return 6 if self.states["ungradable"] or self.unrecognised else 0

    def enrol(self, found: Merged) -> Roster:
        """Note what a roster changed; return what is now the roster."""
        self.moved, self.dropped = found.moved, found.dropped
        return found.roster

    def count(self, results: Results) -> None:
        """Count everything in a gradebook."""
        there = set(results.book.exercise_ids())
        self.pass_marks = [
            (item.pass_share * item.max_points, item.max_points)
            for item in results.exercises()
            if item.id in there
        ]
        self.missing = results.absent()
        self.strangers = results.unmatched(results.students())
        if results.roster is not None and self.strangers:
            self.compared = results.roster.compared(self.strangers, results.downloads)
        for effective in results.all():
            verdict = effective.verdict
            if effective.missing or effective.waiting:
                continue
            settled = effective.override is not None  # a score by hand counts, even without a grading
            self.states["graded" if settled else verdict.state] += 1
            self.passed += effective.passed
            self.unsettled += effective.unsettled
            if verdict.isolation:
                self.levels[verdict.isolation] += 1
            for check in verdict.checks:
                if (check.traceback or "").startswith(OURS):
                    self.unjudged[effective.exercise, check.id, str(check.traceback)] += 1
            if verdict.error is not None and not settled:
                error = verdict.error
                self.troubled.append(
                    Ungraded(effective.student, effective.exercise, verdict.state, error.code, error.message)
                )

"""The totals of a class, counted in one pass; their size depends on the course, not on the class."""

from __future__ import annotations

import heapq
from array import array
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

from course.grading.gradebook.records import GradedExercise
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.results.effective import Effective
from course.scoring.verdict import CheckResult, Status, Visibility

#: Rows of a list on the class page; the tables of numbers have the whole class.
MOST_ROWS = 200
_SLOWEST = 5
_LATEST = 25
_ADVICES = 20  # texts of advice that are counted per diagnosis


@dataclass
class CheckTally:
    """How a check went, over all graded submissions that ran it.

    Attributes:
        latest: one of its results, for its words.
        statuses: number of submissions by how it ended; "unwritten" where its function was not begun.
    """

    latest: CheckResult
    statuses: Counter[str] = field(default_factory=Counter)

    @property
    def submissions(self) -> int:
        return self.statuses.total()

    @property
    def passed(self) -> int:
        return self.statuses[Status.PASS]

    @property
    def hidden(self) -> bool:
        return self.latest.visibility is Visibility.HIDDEN


@dataclass
class TaskTally:
    """Points of a task, summed over graded submissions; how many have all of them, and how many none."""

    exercise: str
    task: str
    points: float = 0.0
    max_points: float = 0.0
    submissions: int = 0
    full: int = 0
    none: int = 0

    @property
    def share(self) -> float:
        return self.points / self.max_points if self.max_points else 0.0


@dataclass
class DiagnosisTally:
    """How many students of an exercise made a known mistake, where, and the advice they got."""

    exercise: str
    code: str
    students: int = 0
    tasks: dict[str, None] = field(default_factory=dict)
    advice: Counter[str] = field(default_factory=Counter)

    @property
    def told(self) -> str:
        return self.advice.most_common(1)[0][0] if self.advice else ""


@dataclass
class ExerciseTally:
    """One exercise over the class.

    Attributes:
        scores: the scores that count, of all students with a grade (including scores set by hand).
        ungraded: results that could not be graded and have no score by hand.
        faults: results without a score because the grader failed.
        missing: enrolled students who handed in nothing.
        waiting: students whose work a run has still to look at.
        seconds: wall time of the checks of each graded submission.
    """

    exercise: GradedExercise
    scores: array[float] = field(default_factory=lambda: array("d"))
    results: int = 0
    handed_in: int = 0
    passed: int = 0
    ungraded: int = 0
    faults: int = 0
    missing: int = 0
    waiting: int = 0
    seconds: array[float] = field(default_factory=lambda: array("d"))
    checks: dict[str, CheckTally] = field(default_factory=dict)
    tasks: dict[str, TaskTally] = field(default_factory=dict)
    diagnoses: dict[str, DiagnosisTally] = field(default_factory=dict)

    @property
    def is_quiz(self) -> bool:
        return self.exercise.id == QUIZ

    def take(self, effective: Effective) -> None:
        verdict = effective.verdict
        if effective.missing or effective.waiting:
            self.missing += effective.missing
            self.waiting += effective.waiting
            return
        self.results += 1
        self.passed += effective.passed
        # An override alone is not a submission.
        self.handed_in += effective.result.number > 0 and (
            verdict.error is None or verdict.error.code != "no_file"
        )
        if effective.score is None:
            self.faults += 1
        elif verdict.state == "graded" or effective.override is not None:
            self.scores.append(effective.score)
        else:
            self.ungraded += 1
        if verdict.state == "graded":
            if not self.is_quiz:
                self.seconds.append(effective.seconds)
            self._take_checks(verdict.checks)

    def _take_checks(self, checks: Sequence[CheckResult]) -> None:
        reached: dict[str, list[float]] = {}
        codes: dict[str, list[CheckResult]] = {}
        for check in checks:
            tally = self.checks.setdefault(check.id, CheckTally(check))
            tally.latest = check
            tally.statuses["unwritten" if check.unwritten else check.status.value] += 1
            sums = reached.setdefault(check.task, [0.0, 0.0])
            sums[0] += check.points
            sums[1] += check.max_points
            if check.diagnosis and not check.unwritten:
                codes.setdefault(check.diagnosis, []).append(check)
        for task, (points, most) in reached.items():
            sums_up = self.tasks.setdefault(task, TaskTally(self.exercise.id, task))
            sums_up.points += points
            sums_up.max_points += most
            sums_up.submissions += 1
            # Rounding of sums of points.
            sums_up.full += points >= most - 1e-9
            sums_up.none += points <= 1e-9
        for code, found in codes.items():
            known = self.diagnoses.setdefault(code, DiagnosisTally(self.exercise.id, code))
            known.students += 1
            known.tasks.update(dict.fromkeys(check.task for check in found))
            for advice in {check.help for check in found if check.help}:
                if advice in known.advice or len(known.advice) < _ADVICES:
                    known.advice[advice] += 1


class CappedList:
    """A list that shows a limited number of rows and counts all.

    Args:
        most: how many it shows.
        by: shows those for which this is largest, the largest first; those that came first if None.
    """

    def __init__(self, most: int = MOST_ROWS, by: Callable[[Effective], float] | None = None) -> None:
        self._most, self._by = most, by
        self._kept: list[tuple[float, int, Effective]] = []
        self.count = 0

    def take(self, effective: Effective) -> None:
        self.count += 1
        rank = self._by(effective) if self._by else 0.0
        heapq.heappush(self._kept, (rank, -self.count, effective))
        if len(self._kept) > self._most:
            heapq.heappop(self._kept)

    @property
    def shown(self) -> list[Effective]:
        return [effective for *_, effective in sorted(self._kept, key=lambda kept: kept[:2], reverse=True)]

    @property
    def left_out(self) -> int:
        return self.count - len(self._kept)


class Tally:
    """A class, counted.

    Args:
        exercises: to count, in the order of the course.

    Attributes:
        troubled: without a grade, for any reason, with or without an instructor's score.
        reasons: number of those by exercise, state and code.
        untimed: number of results without a trusted submission time.
        flagged: number of results that the download calls late, without saying by how much.
        elsewhere: graded without functions that another file of the student's has.
        slowest: those whose checks took longest.
    """

    def __init__(self, exercises: Iterable[GradedExercise]) -> None:
        self.exercises = {item.id: ExerciseTally(item) for item in exercises}
        self.students = 0
        self.levels: Counter[str] = Counter()
        self.versions: Counter[tuple[str, str]] = Counter()
        self.troubled = CappedList()
        self.reasons: Counter[tuple[str, str, str]] = Counter()
        self.overrides = CappedList()
        self.late = CappedList(_LATEST, by=lambda effective: effective.late or 0.0)
        self.penalised = 0
        self.untimed = 0
        self.flagged = 0
        self.elsewhere = CappedList()
        self.slowest = CappedList(_SLOWEST, by=lambda effective: effective.seconds)
        self.first, self.last = "", ""

    def take(self, found: Sequence[Effective]) -> None:
        self.students += 1
        for effective in found:
            self.exercises[effective.exercise].take(effective)
            if effective.missing or effective.waiting:
                continue
            if effective.override is not None:
                self.overrides.take(effective)
            if effective.elsewhere:
                self.elsewhere.take(effective)
            if effective.result.number:
                if effective.late is not None:
                    self.late.take(effective)
                    self.penalised += effective.penalty > 0
                self.untimed += effective.submitted_at is None
                self.flagged += effective.flagged_late
                self._take_grading(effective)

    def _take_grading(self, effective: Effective) -> None:
        verdict, at = effective.verdict, effective.result.graded_at
        self.versions[effective.exercise, effective.result.key.grader_version] += 1
        if verdict.isolation:
            self.levels[verdict.isolation] += 1
        if verdict.error is not None:
            self.troubled.take(effective)
            self.reasons[effective.exercise, verdict.state, verdict.error.code] += 1
        elif not self.exercises[effective.exercise].is_quiz:
            self.slowest.take(effective)
        self.first = min(filter(None, (self.first, at)), default="")
        self.last = max(self.last, at)

    @property
    def hardest(self) -> list[TaskTally]:
        """Tasks by the share of points they gave, the smallest first; questions of a quiz are no tasks."""
        tasks = (one for item in self.exercises.values() if not item.is_quiz for one in item.tasks.values())
        return sorted(tasks, key=lambda task: task.share)

    @property
    def commonest(self) -> list[DiagnosisTally]:
        """Diagnoses by the number of students, the largest first."""
        found = [diagnosis for item in self.exercises.values() for diagnosis in item.diagnoses.values()]
        return sorted(found, key=lambda item: (-item.students, item.exercise, item.code))

"""One student's page, to hand out: what was found, the likely mistake, what to do, and the points.

It has only what ``handout`` lets this student see, and nothing about other students.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.grading.exports.cells import number
from course.grading.exports.handout import checks_for_student, problem_for_student
from course.grading.exports.html_report.rendering import render, shortened
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.printable import one_line
from course.scoring.numbers import in_points, numbers_of
from course.scoring.verdict import CheckResult, Problem, Status, Visibility

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.grading.results.effective import Effective, Results

__all__ = ["student_page"]

_LONGEST_VALUE = 600  # characters: a student's function may return anything
_LONGEST_OUTPUT = 4000
#: Status of a check -> the sign and the words a student reads.
_STATES = {
    Status.PASS: ("✓", "passes"),
    Status.FAIL: ("✗", "does not pass"),
    Status.ERROR: ("✗", "raised an error"),
    Status.TIMEOUT: ("✗", "took too long"),
    Status.MEMORY: ("✗", "used too much memory"),
    Status.CRASH: ("✗", "ended its process"),
    Status.SKIP: ("–", "not run"),
}


@dataclass(frozen=True)
class _Shown:
    """A student's result in one exercise, as the page has it.

    Attributes:
        tasks: unsolved ones first; each with its checks, failed ones first.
    """

    title: str
    effective: Effective
    problem: Problem | None
    tasks: list[tuple[str, list[CheckResult]]]
    titles: dict[str, str]
    bars: list[tuple[str, float, float]]

    @property
    def quiz(self) -> bool:
        return self.effective.exercise == QUIZ

    @property
    def points(self) -> str:
        item = self.effective
        score = "none" if item.missing else "none yet" if item.score is None else number(item.score)
        return f"{score} of {number(item.max_score)}"

    @property
    def outcome(self) -> str:
        """How it ended, in a few words."""
        item = self.effective
        if item.missing:
            return "nothing was handed in"
        if item.waiting:
            return "not graded yet"
        if item.score is None:
            return "to be graded again"
        passed = "passed" if item.passed else "not passed"
        if item.override is not None:
            return f"{passed}, set by the instructor"
        if item.verdict.state != "graded":
            return "could not be graded"
        return f"{passed}, {number(item.penalty)} points off for lateness" if item.penalty else passed


def student_page(results: Results, student: str, found: Sequence[Effective]) -> str:
    """The page about all of one student's work.

    Args:
        found: the student's results, in the order of the course.
    """
    person = results.person(student)
    called = person.name if person and person.name else student
    shown = [_shown(results, item) for item in found]
    scored = [(one.title, one.effective.score, one.effective.max_score) for one in shown]
    return render(
        "student",
        scripted=False,
        title=f"{shortened(one_line(called), 80)}: results",
        course=results.course.id,
        called=called,
        student=student,
        shown=shown,
        scored=[row for row in scored if row[1] is not None],
        state_of=_state_of,
        share_of=_share_of,
        numbers=_numbers,
        cut=_cut,
    )


def _shown(results: Results, item: Effective) -> _Shown:
    checks = checks_for_student(item.verdict)
    by_task: dict[str, list[CheckResult]] = {}
    for check in checks:
        by_task.setdefault(check.task, []).append(check)
    bars = [
        (task, sum(check.points for check in group), sum(check.max_points for check in group))
        for task, group in by_task.items()
    ]
    done = {task: all(check.status is Status.PASS for check in group) for task, group in by_task.items()}
    tasks = sorted(by_task.items(), key=lambda entry: done[entry[0]])
    problem = problem_for_student(item.verdict) if item.result.number else None
    titles = {check.id: check.title for check in checks}
    return _Shown(results.title(item.exercise), item, problem, tasks, titles, bars)


def _state_of(check: CheckResult, quiz: bool) -> tuple[str, str]:
    return ("✗", "not right") if quiz else _STATES.get(check.status, ("✗", "does not pass"))


def _share_of(check: CheckResult) -> str:
    kept_back = ", hidden check" if check.visibility is Visibility.HIDDEN else ""
    points = f"{number(check.points)} of {in_points(check.max_points)}" if check.max_points else "no points"
    return f"{points}{kept_back}"


def _numbers(check: CheckResult) -> list[tuple[str, str]]:
    """The measured and the expected value, and the likely mistake."""
    return [(label, shortened(value, _LONGEST_VALUE)) for label, value in numbers_of(check)]


def _cut(body: str) -> str:
    """Its start and its end, which names the error."""
    if len(body) <= _LONGEST_OUTPUT:
        return body
    half = _LONGEST_OUTPUT // 2
    return f"{body[:half]}\n…\n{body[-half:]}"

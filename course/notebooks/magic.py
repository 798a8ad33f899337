"""``%course_check``: the public checks inside a notebook, through the same boundary as in a terminal.

What is checked is the text of the cells that were run, not the objects in the kernel: the functions run again
in a process of their own, so a check means the same here, in a terminal and in the grading run. In a
workspace it is recorded as `course check` records it.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from course.errors import CourseError, NotFoundError
from course.notebooks.findings import CheckTable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.notebooks.page import ReportPage
    from course.scoring.verdict import Verdict

__all__ = ["check", "register", "report", "typed_in"]


def register(shell: Any) -> None:
    """Make ``%course_check`` and ``%course_report`` known to an IPython shell."""

    def course_check(line: str) -> CheckTable | None:
        """Run the public checks: %course_check EXERCISE [FUNCTION]"""
        words = line.split()
        if not 1 <= len(words) <= 2:
            _said("Write: %course_check EXERCISE [FUNCTION]")
            return None
        try:
            return check(typed_in(shell), *words)
        except CourseError as error:
            _said(f"{error.message} {error.help}")
            return None

    def course_report(line: str) -> ReportPage | None:
        """Show what your functions do on public data: %course_report EXERCISE"""
        words = line.split()
        if len(words) != 1:
            _said("Write: %course_report EXERCISE")
            return None
        try:
            return report(typed_in(shell), words[0])
        except CourseError as error:
            _said(f"{error.message} {error.help}")
            return None

    shell.register_magic_function(course_check, "line", "course_check")
    shell.register_magic_function(course_report, "line", "course_report")


def _said(text: str) -> None:
    print(text)  # noqa: T201 - a cell's output is its screen


def typed_in(shell: Any) -> list[str]:
    """What was run in a shell so far, oldest first, without the cell that asks."""
    return list(shell.history_manager.input_hist_raw[1:-1])


def report(history: Sequence[str], exercise_id: str) -> ReportPage:
    """What the functions that were run do on public data.

    Args:
        history: what was run, oldest first.

    Raises:
        NotFoundError: there is no such exercise, or it has nothing to show.
        UngradableError: there is nothing to run yet, or it cannot be run.
    """
    from course.catalog.load import Catalog
    from course.notebooks.page import ReportPage
    from course.notebooks.typed import module_of
    from course.scoring.reporting import report_of

    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    module = module_of(history, exercise)
    return ReportPage(report_of(exercise, catalog, module.submission(exercise)))


def check(history: Sequence[str], exercise_id: str, task: str | None = None) -> CheckTable:
    """The public checks of an exercise, or of one of its functions, on the cells that were run.

    Args:
        history: what was run, oldest first.

    Raises:
        NotFoundError: there is no such exercise or function.
        UngradableError: there is nothing to check yet.
    """
    from course.catalog.load import Catalog
    from course.notebooks.typed import defines_all, module_of
    from course.scoring.session import GradingSession

    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    known = [one.id for one in exercise.task]
    if task is not None and task not in known:
        raise NotFoundError(
            f"{exercise_id} has no function {task}.", help=f"It has: {', '.join(known)}.", code="no_such_task"
        )
    module = module_of(history, exercise)
    begin = time.perf_counter()
    with GradingSession(exercise, catalog, scope="public") as session:
        verdict = session.grade(module.submission(exercise))
    seconds = time.perf_counter() - begin
    if task is not None and not defines_all(module.source, known):
        # What was not run yet is not missing: the attempt is at this function alone.
        verdict = _of_task(verdict, exercise, task)
        note = _recorded(catalog, exercise, verdict, module.source, seconds, only=task)
    else:
        note = _recorded(catalog, exercise, verdict, module.source, seconds)
    return CheckTable(verdict, task, note)


def _of_task(verdict: Verdict, exercise: Exercise, task: str) -> Verdict:
    """The part of a verdict that is about one function."""
    import msgspec

    if verdict.state != "graded":
        return verdict
    checks = tuple(check for check in verdict.checks if check.task == task)
    score, most = sum(check.points for check in checks), sum(check.max_points for check in checks)
    return msgspec.structs.replace(
        verdict, checks=checks, score=score, max_score=most, passed=score >= exercise.pass_mark * most
    )


def _recorded(
    catalog: Catalog, exercise: Exercise, verdict: Verdict, source: bytes, seconds: float, *, only: str = ""
) -> str:
    """Add an attempt to the progress of the workspace this kernel runs in; what there is to say about that.

    Outside of a workspace there is no record, and nothing to say.
    """
    from pathlib import Path

    from course.progress.history import check_data
    from course.progress.workspace import Workspace

    try:
        workspace = Workspace.find(Path.cwd())
        if workspace.course_id != catalog.course_id:
            return f"This was not recorded: {workspace.root} is a workspace of another course."
        data = check_data(verdict, source, seconds, catalog.version, only=only)
        workspace.store.append("check", exercise.id, data)
    except (NotFoundError, FileNotFoundError):  # also where the folder is gone
        return ""
    except CourseError as error:
        return f"This was not recorded: {error.message} {error.help}"
    return ""

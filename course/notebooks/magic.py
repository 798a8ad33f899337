"""``%course_check``: the public checks inside a notebook, through the same boundary as in a terminal.

With ``%%course_check`` at its head, a cell is the whole file and does not run in the kernel. Otherwise the
text of the notebook is checked, as it would be handed in, and not the objects in the kernel: the functions
run again in a process of their own, so a check means the same here, in a terminal and in the grading run. In
a workspace the attempt is recorded as `course check` records it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from course.errors import CourseError
from course.notebooks import checking
from course.notebooks.checking import checked, must_have
from course.notebooks.typed import Runs, at_hand

if TYPE_CHECKING:
    from course.notebooks.findings import CheckTable
    from course.notebooks.page import ReportPage

__all__ = ["check", "check_cell", "register", "report"]


def register(shell: Any) -> None:
    """Add ``%course_check`` and ``%course_report`` to an IPython shell."""
    shell.course_runs = Runs(shell)

    def course_check(line: str, cell: str | None = None) -> CheckTable | None:
        """Run the public checks: %course_check EXERCISE [FUNCTION]; with %% on the cell as a file."""
        words = line.split()
        if not 1 <= len(words) <= 2:
            _said("Write: %course_check EXERCISE [FUNCTION]")
            return None
        try:
            if cell is not None:
                return check_cell(f"{cell}\n", *words)
            return check(shell, *words)
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
            return report(shell, words[0])
        except CourseError as error:
            _said(f"{error.message} {error.help}")
            return None

    shell.register_magic_function(course_check, "line_cell", "course_check")
    shell.register_magic_function(course_report, "line", "course_report")


def _said(text: str) -> None:
    print(text)  # noqa: T201 - a cell's output is its screen


def report(shell: Any, exercise_id: str) -> ReportPage:
    """A report: what the functions of a notebook do on public data.

    Args:
        shell: of IPython, that runs it.

    Raises:
        NotFoundError: there is no such exercise, or it has nothing to show.
        UngradableError: there is nothing to run yet, or it cannot be run.
    """
    from course.catalog.load import Catalog
    from course.notebooks.page import ReportPage
    from course.scoring.judging.reporting import report_of

    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    return ReportPage(report_of(exercise, catalog, at_hand(shell, exercise).submission(exercise)))


def check(shell: Any, exercise_id: str, task: str | None = None) -> CheckTable:
    """The public checks of an exercise, or of one of its functions, on a notebook.

    Args:
        shell: of IPython, that runs it.

    Raises:
        NotFoundError: there is no such exercise or function.
        UngradableError: there is nothing to check yet.
    """
    from course.catalog.load import Catalog

    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    must_have(exercise, task)
    return checked(catalog, exercise, at_hand(shell, exercise).submission(exercise), task)


def check_cell(text: str, exercise_id: str, task: str | None = None) -> CheckTable:
    """The public checks on a text; where all pass and there is a report, that is shown, too.

    Raises:
        NotFoundError: there is no such exercise or function.
    """
    from course.catalog.load import Catalog
    from course.notebooks.page import ReportPage
    from course.scoring.judging.reporting import has_report, report_of
    from course.scoring.judging.submission import Submission

    table = checking.check(exercise_id, task, text)
    exercise = Catalog().exercise(exercise_id)
    if table.passed and has_report(exercise):
        table.report = ReportPage(
            report_of(exercise, Catalog(), Submission({exercise.module: text.encode()}))
        )
    return table

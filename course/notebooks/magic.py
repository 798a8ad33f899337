"""``%course_check`` and its kin: checks in a notebook, through the same boundary as in a terminal.

With ``%%course_check`` at its head, a cell is the whole file and does not run in the kernel. Otherwise the
text of the notebook is checked, as it would be handed in, and not the objects in the kernel: the functions
run again in a process of their own, so a check means the same here, in a terminal and in the grading run. In
a workspace the attempt is recorded as `course check` records it.
"""

import ast
import contextlib
import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, TypeVar

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.errors import CourseError
from course.handed_in.notebook import SOLUTION
from course.notebooks.cells import Cell, document
from course.notebooks.checking import NOT_SAVED, CheckTable, Runs, at_hand, check
from course.notebooks.show import ReportPage
from course.scoring.judging.session import check_files, has_report, report_of
from course.scoring.judging.submission import Submission

T = TypeVar("T")


def register(shell: Any) -> None:
    shell.course_runs = Runs(shell)

    def course_check(line: str, cell: str | None = None) -> CheckTable | None:
        """Run the public checks, with %% on the cell as a file: %course_check EXERCISE [FUNCTION]"""
        words = line.split()
        fits = 1 <= len(words) <= 2
        if cell is None:
            return _told(fits, course_check, lambda: check(*words, shell=shell))
        return _told(fits, course_check, lambda: check_cell(f"{cell}\n", *words))

    def course_report(line: str) -> ReportPage | None:
        """Show what your functions do on public data: %course_report EXERCISE"""
        words = line.split()
        return _told(len(words) == 1, course_report, lambda: report(shell, *words))

    def course_hint(line: str) -> None:
        """The next hint, after a check that failed: %course_hint EXERCISE [FUNCTION]"""
        first, *rest = line.split() or [""]
        words = [first, *(f"--task={task}" for task in rest)]
        _told(bool(first) and len(rest) < 2, course_hint, partial(_run, "hint", *words))

    def course_progress(line: str) -> None:
        """What you have done in this workspace: %course_progress"""
        _told(not line, course_progress, partial(_run, "progress"))

    def course_submit(line: str) -> None:
        """Write the file to hand in: %course_submit [EXERCISE ...]"""
        _run("submit", *line.split())
        for exercise in Catalog().exercises():
            with contextlib.suppress(CourseError):  # this notebook is not about it
                notes = at_hand(shell, exercise).notes
                print(*(f"{note}\n" for note in notes if NOT_SAVED in note), sep="", end="")  # noqa: T201

    shell.register_magic_function(course_check, "line_cell", "course_check")
    for magic in (course_report, course_hint, course_progress, course_submit):
        shell.register_magic_function(magic, "line", magic.__name__)


#: A command of which there is a magic, about an exercise.
_COMMAND = re.compile(r"\bcourse (check|hint|progress|submit)(?= [a-z][\w-]*(?![\w./-]))")


def _run(*words: str) -> None:
    """Run a command of the course as a terminal would, in the notebook's folder, and show what it says."""
    done = subprocess.run(
        [sys.executable, "-P", "-m", "course", *words],
        capture_output=True, encoding="utf-8", errors="replace", check=False,
        env={**os.environ, "PYTHONIOENCODING": "utf-8", "NO_COLOR": "1"},
    )  # fmt: skip
    said = _COMMAND.sub(r"%course_\1", done.stdout + done.stderr)
    print(said.rstrip("\n"))  # noqa: T201 - a cell's output is its screen


def _told(fits: bool, magic: Callable[..., object], act: Callable[[], T]) -> T | None:
    """What was asked for; or None, with a sentence about what is wrong: where it does not fit, its usage."""
    wrong = f"Write: {(magic.__doc__ or '').rpartition(': ')[2]}"
    try:
        if fits:
            return act()
    except CourseError as error:
        wrong = f"{error.message} {error.help}"
    except KeyboardInterrupt:
        wrong = "Interrupted; nothing was recorded."
    print(wrong)  # noqa: T201 - a cell's output is its screen
    return None


def report(shell: Any, exercise_id: str) -> ReportPage:
    """A report: what the functions of a notebook do on public data.

    Raises:
        NotFoundError: there is no such exercise, or it has nothing to show.
        UngradableError: there is nothing to run yet, or it cannot be run.
    """
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    return ReportPage(report_of(exercise, catalog, at_hand(shell, exercise).submission(exercise)))


def check_cell(text: str, exercise_id: str, task: str | None = None) -> CheckTable:
    """The public checks on a text; where all pass and there is a report, that is shown, too.

    Raises:
        NotFoundError: there is no such exercise or function.
    """
    table = check(exercise_id, task, text)
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    if table.passed and has_report(exercise):
        table.report = ReportPage(report_of(exercise, catalog, Submission({exercise.module: text.encode()})))
    return table


# ---
# Exercises for an existing nbgrader site: the same cells, with nbgrader's metadata.
#
# Here a check cell gives its function's points as a number, which nbgrader reads as partial credit. The code
# runs in the kernel of the student's notebook, as everything in nbgrader does, so a student can make any cell
# print any number. The score that counts comes from ``course grade run``, which takes these notebooks as
# submissions.


#: The version of nbgrader's cell metadata.
SCHEMA_VERSION = 3

_BEGIN, _END = "### BEGIN SOLUTION", "### END SOLUTION"
_CHECK = 'from course.notebooks.magic import points\n\npoints("{exercise}", "{task}")'


def nbgrader_notebook(catalog: Catalog, exercise: Exercise) -> bytes:
    """The source notebook of an nbgrader assignment.

    A function's cell is a solution cell whose body nbgrader replaces by its own stub when it makes the
    students' version; the check below it is a locked, graded cell worth the function's public points.

    Raises:
        ContentError: a check file is wrong.
    """
    from course.notebooks.build import exercise_cells

    worth = _public_points(catalog, exercise)
    stub = exercise.stub_path.read_text(encoding="utf-8")
    cells = [_marked(cell, worth) for cell in exercise_cells(exercise, stub)]
    return document(cells, kind="nbgrader", id=exercise.id, version=catalog.version)


def points(exercise_id: str, task: str) -> float:
    """Run and show the public checks of a function in this notebook, and return the points.

    Raises:
        NotFoundError: there is no such exercise or function.
        UngradableError: there is nothing to check yet.
    """
    import IPython.display
    from IPython.core.getipython import get_ipython

    table = check(exercise_id, task, shell=get_ipython())
    show: Callable[..., object] = IPython.display.display  # typed or not, whether it is installed or not
    show(table)
    return float(sum(one.points for one in table.checks))


def _public_points(catalog: Catalog, exercise: Exercise) -> dict[str, float]:
    from course.scoring.checks.collected import CollectedChecks

    worth: dict[str, float] = defaultdict(float)
    with contextlib.closing(CollectedChecks(check_files(exercise, catalog, "public"))) as collected:
        for check in collected.checks:
            worth[check.task] += check.points
    return worth


def _marked(cell: Cell, worth: Mapping[str, float]) -> Cell:
    """The cell, with nbgrader's metadata where nbgrader uses it."""
    role, task = cell.tags.get("role"), cell.tags.get("task", "")
    if role == SOLUTION:
        source = _with_region(cell.source)
        return cell if source is None else _with(cell, source, f"solution-{task}", solution=True)
    if role == "check" and task in worth:
        source = _CHECK.format(exercise=cell.tags["exercise"], task=task)
        return _with(cell, source, f"check-{task}", grade=True, locked=True, points=worth[task])
    if role == "tools":
        return _with(cell, cell.source, "tools", locked=True)
    return cell


def _with(cell: Cell, source: str, grade_id: str, **flags: Any) -> Cell:
    held = {"grade": False, "solution": False, "locked": False, "task": False, **flags}
    entry = {"schema_version": SCHEMA_VERSION, "grade_id": re.sub(r"[^\w-]", "-", grade_id), **held}
    return Cell(cell.kind, source, {**cell.metadata, "nbgrader": entry})


def _with_region(source: str) -> str | None:
    """The source, with nbgrader's marks around the part a student replaces; None if there is none."""
    functions = [node for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
    last = functions[-1].body[-1] if functions else None
    if not isinstance(last, ast.Raise):
        return None
    lines = source.split("\n")
    indent = " " * last.col_offset
    end = last.end_lineno or last.lineno
    region = [indent + _BEGIN, *lines[last.lineno - 1 : end], indent + _END]
    return "\n".join([*lines[: last.lineno - 1], *region, *lines[end:]])

"""``course notebook check``: the public checks on a notebook's functions, with cells for line numbers."""

from __future__ import annotations

import time
from pathlib import Path  # noqa: TC003 - functions here take paths, and annotations are read
from typing import TYPE_CHECKING

from course.cli.frame.here import cwd, find_workspace, load_catalog
from course.cli.frame.terminal.console import Console  # noqa: TC001 - functions here take it, and annotations are read
from course.cli.notebook.replies import NotebookCheck
from course.cli.work import checking
from course.cli.work.verdict.screen import show_verdict
from course.errors import NotFoundError, UngradableError
from course.handed_in.cells import code_cells, read_notebook

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.cli.frame.here import Here

__all__ = ["check_file"]


def check_file(console: Console, file: Path, exercise_id: str | None, *, verbose: bool) -> int:
    """Check one notebook, show what was found, and give the exit code.

    Raises:
        UngradableError: it is not a notebook, or has nothing to check.
        NotFoundError: there is no such file or exercise, or the exercise is not clear.
    """
    from course.handed_in.notebook import notebook_source

    path = cwd() / file.expanduser()
    if not path.exists():
        raise NotFoundError(
            f"There is no file {file}.", help="`course notebook build` writes notebooks.", code="no_file"
        )
    data = read_notebook(path)
    here, catalog = _course()
    exercise = _exercise(catalog, path, data, exercise_id)
    module = notebook_source(data, exercise, file.name)
    with console.working(f"Checking {exercise.id}"):
        begin = time.perf_counter()
        with checking.open_session(exercise, catalog) as session:
            verdict = checking.grade_once(session, module.submission(exercise))
        seconds = time.perf_counter() - begin
    if here is not None and path.is_relative_to(here.workspace.root):
        checking.record_verdict(here, exercise, module.source, verdict, seconds)
    problem = checking.error_without_checks(verdict)
    if problem is not None:
        raise problem
    show_verdict(console, exercise, verdict, verbose=verbose)
    for warning in here.warnings if here else ():
        console.warn(warning)
    course = catalog.ref
    reply = checking.reply_to(course, verdict, f"course notebook check {file}")
    console.emit(NotebookCheck(ok=reply.ok, exit_code=reply.exit_code, file=str(path), result=reply))
    return reply.exit_code


def _course() -> tuple[Here | None, Catalog]:
    here = find_workspace()
    return here, here.catalog if here is not None else load_catalog()


def _exercise(catalog: Catalog, path: Path, data: bytes, wanted: str | None) -> Exercise:
    """A notebook's exercise: the given one, or the one that its cells, its name or its functions show."""
    from course.handed_in.notebook import notebook_source

    if wanted is not None:
        return catalog.exercise(wanted)
    exercises = catalog.exercises()
    marks = [cell.tags.get("exercise") for cell in code_cells(data, path.name)]
    for exercise in exercises:
        if exercise.id in marks:
            return exercise
    module = f"{path.stem}.py"
    for exercise in exercises:
        if path.stem == exercise.id or module == exercise.module:
            return exercise
    for exercise in exercises:
        try:
            notebook_source(data, exercise)
        except UngradableError:
            continue
        return exercise
    raise NotFoundError(
        f"{path.name} does not say which exercise it is about, and defines no function of any.",
        help="Say which with --exercise.",
        code="which_exercise",
    )

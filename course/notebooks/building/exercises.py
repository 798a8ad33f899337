"""An exercise as a notebook: its README, a cell for each function, and its public checks after each."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from course.handed_in.notebook import SETUP, SOLUTION
from course.notebooks.building.cells import Cell, code, document, markdown, opening
from course.notebooks.building.stub import pieces
from course.scoring.judging.reporting import has_report

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise, Task

__all__ = ["exercise_cells", "exercise_notebook"]

_LOAD = "%load_ext course.notebooks"
_HOW = """\
## Work in the cells below

Write each function in its cell, run the cell, then run the check below it. Only the cells with your functions
are graded, and whatever other cells define that they use; plots, experiments and outputs are yours. Save the
notebook and hand it in with `course submit`, or check the whole file from a terminal with
`course notebook check {file}`."""
_LAST = """\
## All of it

All public checks at once; the hidden ones run when it is graded."""
#: A link between files of the course: a notebook may lie anywhere, so it cannot follow it.
_LINK = re.compile(r"\[([^\]]+)\]\((lesson|exercise):([a-z0-9-]+)[^)]*\)")
_REPORT = """\
## See what your code does

Your functions on public data, in words, tables and figures. Sections that need a function you have not
written yet say so."""


def exercise_notebook(catalog: Catalog, exercise: Exercise) -> bytes:
    """The notebook file of an exercise, with its stub's functions to fill in."""
    cells = exercise_cells(exercise, exercise.stub_path.read_text(encoding="utf-8"))
    return document(cells, kind="exercise", id=exercise.id, version=catalog.version)


def exercise_cells(exercise: Exercise, source: str) -> list[Cell]:
    """The cells, in the order in which a student works through them.

    Args:
        source: the module's text: the stub, or a student's work that goes into a notebook.
    """
    tasks = {task.id: task for task in exercise.task}
    about, parts = pieces(source, tasks)
    readme = _LINK.sub(_as_command, exercise.readme_path.read_text(encoding="utf-8"))
    first, *rest = _sections(readme)
    cells = [opening(first), *map(markdown, rest)]
    cells.append(markdown(f"{_HOW.format(file=exercise.stub_path.with_suffix('.ipynb').name)}\n\n{about}"))
    cells.append(code(_LOAD, role="tools", exercise=exercise.id))
    for part in parts:
        if not part.task:
            cells.append(code(part.text, role=SETUP, exercise=exercise.id))
            continue
        cells.append(markdown(_task_heading(tasks[part.task])))
        cells.append(code(part.text, role=SOLUTION, exercise=exercise.id, task=part.task))
        cells.append(
            code(
                f"%course_check {exercise.id} {part.task}", role="check", exercise=exercise.id, task=part.task
            )
        )
    cells.append(markdown(_LAST))
    cells.append(code(f"%course_check {exercise.id}", role="check", exercise=exercise.id))
    if has_report(exercise):
        cells.append(markdown(_REPORT))
        cells.append(code(f"%course_report {exercise.id}", role="report", exercise=exercise.id))
    return cells


def _as_command(link: re.Match[str]) -> str:
    words, kind, name = link.groups()
    return f"{words} (`course {'start' if kind == 'exercise' else 'lesson'} {name}`)"


def _sections(readme: str) -> list[str]:
    """A README, cut before each second-level heading; fenced blocks stay whole."""
    found: list[list[str]] = [[]]
    fenced = False
    for line in readme.strip("\n").split("\n"):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
        if line.startswith("## ") and not fenced:
            found.append([])
        found[-1].append(line)
    return ["\n".join(lines) for lines in found if any(lines)]


def _task_heading(task: Task) -> str:
    return f"### {task.title}: `{task.id}` ({task.points:g} points)"

"""Exercises for an existing nbgrader site: the same cells, with nbgrader's metadata.

Here a check cell gives its function's points as a number, which nbgrader reads as partial credit. The code
runs in the kernel of the student's notebook, as everything in nbgrader does, so a student can make any cell
print any number. The score that counts comes from ``course grade run``, which takes these notebooks as
submissions.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING, Any

from course.handed_in.notebook import SOLUTION
from course.notebooks.building.cells import Cell, document

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["SCHEMA_VERSION", "nbgrader_notebook", "points"]

#: The version of nbgrader's cell metadata.
SCHEMA_VERSION = 3

_BEGIN, _END = "### BEGIN SOLUTION", "### END SOLUTION"
_CHECK = 'from course.notebooks.nbgrader import points\n\npoints("{exercise}", "{task}")'


def nbgrader_notebook(catalog: Catalog, exercise: Exercise) -> bytes:
    """The source notebook of an nbgrader assignment.

    A function's cell is a solution cell whose body nbgrader replaces by its own stub when it makes the
    students' version; the check below it is a locked, graded cell worth the function's public points.

    Raises:
        ContentError: a check file is wrong.
    """
    from course.notebooks.building.exercises import exercise_cells

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

    from course.notebooks.magic import check

    table = check(get_ipython(), exercise_id, task)
    show: Callable[..., object] = IPython.display.display  # typed or not, whether it is installed or not
    show(table)
    return float(sum(one.points for one in table.checks))


def _public_points(catalog: Catalog, exercise: Exercise) -> dict[str, float]:
    """Public points of each task."""
    from course.scoring.checks.collected import CollectedChecks
    from course.scoring.judging.session import check_files

    collected = CollectedChecks(check_files(exercise, catalog, "public"))
    try:
        worth: dict[str, float] = {}
        for check in collected.checks:
            worth[check.task] = worth.get(check.task, 0.0) + check.points
        return worth
    finally:
        collected.close()


def _marked(cell: Cell, worth: Mapping[str, float]) -> Cell:
    """The cell, with nbgrader's metadata where nbgrader uses it."""
    role, task = cell.tags.get("role"), cell.tags.get("task", "")
    if role == SOLUTION:
        source = _with_region(cell.source)
        if source is None:
            return cell
        return _with(Cell(cell.kind, source, cell.metadata), f"solution-{task}", solution=True)
    if role == "check" and task in worth:
        source = _CHECK.format(exercise=cell.tags["exercise"], task=task)
        held = Cell(cell.kind, source, cell.metadata)
        return _with(held, f"check-{task}", grade=True, locked=True, points=worth[task])
    if role == "tools":
        return _with(cell, "tools", locked=True)
    return cell


def _with(cell: Cell, grade_id: str, **flags: Any) -> Cell:
    held = {"grade": False, "solution": False, "locked": False, "task": False, **flags}
    entry = {"schema_version": SCHEMA_VERSION, "grade_id": re.sub(r"[^\w-]", "-", grade_id), **held}
    return Cell(cell.kind, cell.source, {**cell.metadata, "nbgrader": entry})


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

"""A warm-up in its place in a lesson's notebook: its text, and a cell that checks itself when it is run.

The cell stands for the warm-up's file. It does not run in the notebook's kernel, so its names cannot change
the results of the lesson's own cells.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.notebooks.building.cells import Cell, code, markdown

if TYPE_CHECKING:
    from course.catalog import blocks as b
    from course.catalog.models import Exercise
    from course.notebooks.building.lowering import Lowering

__all__ = ["warm_up_cells"]

_ASKED = """\
### Warm-up: {title}

*About {minutes} minutes; it counts for nothing. The cell below is its file: change it and run it, and it is
checked at once.*

{text}"""


def warm_up_cells(exercise: Exercise, task: b.Task, lowering: Lowering) -> list[Cell]:
    """Its text, and the stub to mend or to fill in."""
    text = "\n\n".join(lowering.block(block) for block in task.blocks)
    asked = _ASKED.format(title=task.title, minutes=exercise.minutes, text=text)
    stub = exercise.stub_path.read_text(encoding="utf-8")
    return [
        markdown(asked, role="warm-up", exercise=exercise.id),
        code(f"%%course_check {exercise.id}\n{stub}", role="warm-up", exercise=exercise.id),
    ]

"""A lesson as a notebook: its text, its code and figures as running cells, a cell for each prediction."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.catalog import blocks as b
from course.catalog.markdown import read_blocks
from course.notebooks.building.cells import Cell, code, document, markdown, opening
from course.notebooks.building.lowering import Lowering
from course.notebooks.building.warm_ups import warm_up_cells
from course.reading.parts import with_tasks

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Lesson
    from course.notebooks.building.layout import Layout

__all__ = ["lesson_cells", "lesson_notebook"]

_FIGURES = "from course.notebooks.show import figure"
_CHECKS = "%load_ext course.notebooks"
_PREDICTIONS = "from course.notebooks.predicting import predict"


def lesson_notebook(catalog: Catalog, lesson: Lesson, layout: Layout) -> bytes:
    """The notebook file of a lesson.

    Raises:
        ContentError: the lesson's file is wrong.
    """
    cells = lesson_cells(catalog, lesson, layout)
    return document(cells, kind="lesson", id=lesson.id, version=catalog.version)


def lesson_cells(catalog: Catalog, lesson: Lesson, layout: Layout) -> list[Cell]:
    """The cells, in reading order; the text between two code cells is one cell for each section."""
    tasks = {one.id: one for one in catalog.warm_ups(lesson.id)}
    blocks = with_tasks(read_blocks(catalog.content.lessons / f"{lesson.id}.md"), tuple(tasks.values()))
    lowering = Lowering(layout.links(catalog, lesson.id))
    cells = [opening(_head(lesson))]
    kinds = {type(block) for block in b.walk_blocks(blocks)}
    needed = ((b.Task, _CHECKS), (b.Figure, _FIGURES), (b.Prediction, _PREDICTIONS))
    setup = [line for kind, line in needed if kind in kinds]
    if setup:
        cells.append(code("\n".join(setup), role="setup"))
    text: list[str] = []
    predictions = 0

    def flush() -> None:
        if text:
            cells.append(markdown("\n\n".join(text)))
            text.clear()

    for block in blocks:
        match block:
            case b.CodeCell(source=source, hidden=hidden):
                flush()
                cells.append(code(source, role="hidden" if hidden else "lesson"))
            case b.Figure(id=name, alt=alt, caption=caption):
                flush()
                cells.append(code(f'figure("{name}")', role="figure"))
                cells.append(markdown(f"*{lowering.inlines(caption)}*\n\n{_described(alt)}"))
            case b.Prediction(blocks=inner):
                flush()
                predictions += 1
                cells.append(markdown(lowering.boxed("predict", inner)))
                cells.append(code(_PREDICT.format(number=predictions, lesson=lesson.id), role="prediction"))
            case b.Task(id=name):
                flush()
                cells += warm_up_cells(tasks[name], block, lowering)
            case b.Callout(kind="answer"):
                text.append(_FOLDED.format(answer=lowering.block(block)))
            case b.Heading():
                flush()
                text.append(lowering.block(block))
            case _:
                text.append(lowering.block(block))
    flush()
    return [_collapsed(cell) for cell in cells]


_PREDICT = '''my_prediction_{number} = """

"""  # write it down before you go on: a guess that is written is a guess that teaches
predict("{lesson}", {number}, my_prediction_{number})'''
_FOLDED = """\
<details><summary>The answer: predict first</summary>

{answer}

</details>"""


def _head(lesson: Lesson) -> str:
    objectives = "\n".join(f"- {objective}" for objective in lesson.objectives)
    return (
        f"# {lesson.title}\n\n{lesson.summary}\n\n"
        f"About {lesson.minutes} minutes. Afterwards you can:\n\n{objectives}"
    )


def _described(alt: str) -> str:
    return f"<details><summary>What the figure shows, in words</summary>{alt}</details>"


def _collapsed(cell: Cell) -> Cell:
    """Code that only makes numbers or pictures starts folded; it still runs."""
    if cell.metadata.get("course", {}).get("role") not in {"hidden", "figure", "setup"}:
        return cell
    return Cell(cell.kind, cell.source, {**cell.metadata, "jupyter": {"source_hidden": True}})

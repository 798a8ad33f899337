"""Which file of an exercise is handed in: the module, or the notebook that was worked in instead."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from course.errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.catalog.models import Exercise
    from course.cli.here import Here
    from course.cli.schemas import FileReply

__all__ = ["Work", "work_of"]


@dataclass(frozen=True)
class Work:
    """What is handed in for one exercise.

    Attributes:
        name: of the file.
        data: its content as it is handed in; a notebook without its outputs.
        source: the module that is graded.
    """

    exercise: Exercise
    name: str
    data: bytes
    source: bytes

    @property
    def path(self) -> str:
        """Where it lies in the archive."""
        return f"{self.exercise.id}/{self.name}"


def work_of(here: Here) -> tuple[list[Work], list[FileReply]]:
    """What goes in, and what does not and why."""
    chosen: list[Work] = []
    left_out: list[FileReply] = []
    for exercise in here.catalog.exercises():
        module = _module(here, exercise)
        notebook, why_not = _notebook(here, exercise)
        if isinstance(module, Work):
            chosen.append(module)
            why_not = f"{exercise.module} was worked in too, and is handed in" if notebook else why_not
        elif notebook is not None:
            chosen.append(notebook)
        elif module == _STUB or (module == _MISSING and _was_started(here, exercise)):
            left_out += _reply(exercise, exercise.module, str(module))
        if why_not:
            left_out += _reply(exercise, _notebook_name(exercise), why_not)
    return chosen, left_out


_STUB, _MISSING = "still the stub", "not there"


def _reply(exercise: Exercise, name: str, why: str) -> Iterator[FileReply]:
    from course.cli.schemas import FileReply

    yield FileReply(path=f"{exercise.id}/{name}", action=why)


def _was_started(here: Here, exercise: Exercise) -> bool:
    return exercise.id in here.workspace.started()


def _notebook_name(exercise: Exercise) -> str:
    return Path(exercise.module).with_suffix(".ipynb").name


def _module(here: Here, exercise: Exercise) -> Work | str:
    """The module as it is handed in, or why it is not."""
    if not here.workspace.path(exercise.id, exercise.module).exists():
        return _MISSING
    source = here.source(exercise)
    if not here.workspace.is_edited(exercise.id, exercise.module, source):
        return _STUB
    return Work(exercise, exercise.module, source, source)


def _notebook(here: Here, exercise: Exercise) -> tuple[Work | None, str]:
    """The notebook as it is handed in; or None and why not, "" where there is none."""
    from course.cli.here import MAX_FILE_BYTES
    from course.cli.notebook_files import read
    from course.grading.notebook_source import notebook_source
    from course.notebooks.exercises import exercise_notebook
    from course.progress.history import fingerprint

    name = _notebook_name(exercise)
    path = here.workspace.path(exercise.id, name)
    if not path.exists():
        return None, ""
    try:
        data = read(path)
        module = notebook_source(data, exercise, name)
    except CourseError as problem:
        return None, problem.message.rstrip(".")
    given = notebook_source(exercise_notebook(here.catalog, exercise), exercise)
    if fingerprint(module.source) == fingerprint(given.source):
        return None, _STUB
    small = _without_outputs(data)
    if len(small) > MAX_FILE_BYTES:
        return None, f"larger than {MAX_FILE_BYTES:,} bytes without its outputs, which no grading run takes"
    return Work(exercise, name, small, module.source), ""


def _without_outputs(data: bytes) -> bytes:
    """A notebook as it was before it was run: outputs are large, and nobody grades them."""
    from course.notebooks.cells import dumped

    notebook = json.loads(data.decode("utf-8-sig"))
    sheets = [notebook, *notebook.get("worksheets", [])]
    for cell in (cell for sheet in sheets for cell in sheet.get("cells", [])):
        cell.pop("attachments", None)
        if cell.get("cell_type") == "code":
            cell["outputs"] = []
            cell["execution_count"] = None
    return dumped(notebook)

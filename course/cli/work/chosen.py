"""Which file of an exercise counts: the module, or the notebook if the student worked in that.

One rule holds for handing in and for everything before it (check, watch, diff, report): the module counts,
unless it is missing, or is still the stub while the notebook was edited. So a check reads the file that will
be handed in.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from course.catalog.models import Exercise
from course.cli.frame.here import Here, named
from course.cli.frame.replies import FileReply
from course.errors import CourseError, NotFoundError, UngradableError
from course.handed_in.limits import MAX_FILE, must_fit, read_notebook
from course.notebooks.cells import dumped
from course.notebooks.merge import is_untouched
from course.printable import command
from course.progress.history import fingerprint
from course.progress.workspace import same_text

if TYPE_CHECKING:
    from course.handed_in.notebook import NotebookSource
    from course.scoring.judging.submission import Submission

NOTEBOOK = ".ipynb"


@dataclass(frozen=True)
class StudentWork:
    """A student's file for one exercise.

    Attributes:
        name: of the file.
        data: its content, unchanged.
        source: the module that is graded.
        stub: the module as it was handed out, as this kind of file holds it.
        notebook: the cells of the module's lines; None if the file is the module itself.
        notes: other files of this exercise that do not count, a sentence each.
    """

    exercise: Exercise
    name: str
    data: bytes
    source: bytes
    stub: bytes
    notebook: NotebookSource | None = None
    notes: tuple[str, ...] = ()

    @property
    def path(self) -> str:
        """Where it lies in the workspace, and in the archive that is handed in."""
        return f"{self.exercise.place}/{self.name}"

    @property
    def submission(self) -> Submission:
        """The part that is graded."""
        if self.notebook is not None:
            return self.notebook.submission(self.exercise)
        from course.scoring.judging.submission import Submission

        return Submission({self.exercise.module: self.source})


def asked_for(here: Here, wanted: str | None) -> tuple[Exercise, str | None]:
    """The exercise that a command is about, and its file if a path was given ("springs/springs.ipynb").

    Raises:
        NotFoundError: there is no such exercise or file.
    """
    if wanted is None or Path(wanted).suffix not in (".py", NOTEBOOK):
        return here.exercise(wanted), None
    path = Path(os.path.realpath(named(wanted)))
    for exercise in here.known.values():
        for name in (exercise.module, _notebook_name(exercise)):
            if path == Path(os.path.realpath(here.workspace.path(exercise.place, name))):
                return exercise, name
    check = command("notebook", "check", wanted)
    elsewhere = f"; {check} checks this notebook" if path.suffix == NOTEBOOK else ""
    problem = f"{wanted} is not where a file of an exercise lies in this workspace."
    raise NotFoundError(problem, help=f"Name the exercise{elsewhere}.", code="exercise_not_found")


def chosen_work(here: Here, exercise: Exercise, named: str | None = None) -> StudentWork:
    """The file of an exercise that counts, or the named one.

    Raises:
        UngradableError: there is none, it cannot be read, or it has nothing to grade.
    """
    notebook_there = False
    with suppress(OSError):  # in a folder that cannot be read; that is said of the module
        notebook_there = here.workspace.path(exercise.place, _notebook_name(exercise)).exists()
    if named == _notebook_name(exercise):
        return _notebook(here, exercise)
    if named is not None or not notebook_there:
        return _module(here, exercise)
    if not here.workspace.path(exercise.place, exercise.module).exists():
        return _notebook(here, exercise)
    module = _module(here, exercise)
    if not is_edited(module):
        notebook = _notebook(here, exercise)
        return notebook if is_edited(notebook) else module
    return _beside_notebook(here, module)


def name_of_work(here: Here, exercise: Exercise) -> str:
    """The name of the file that counts; the module's where neither can be read."""
    notebook = _notebook_name(exercise)
    with suppress(OSError, CourseError):
        paths = [here.workspace.path(exercise.place, name) for name in (exercise.module, notebook)]
        if paths[1].is_file() and not paths[0].exists():
            return notebook
        return chosen_work(here, exercise).name
    return exercise.module


def worked_on(here: Here) -> tuple[Exercise, ...]:
    """The exercises that were started, that have a file, or whose notebook was edited.

    A repository may lack the record of started exercises, but it has the files.
    """
    started, found = here.workspace.started(), []
    for one in here.catalog.exercises():
        there = one.id in started or here.workspace.path(one.place, one.module).is_file() or here.unread(one)
        if there or _handed_in_notebook(here, one)[0] is not None:
            found.append(one)
    return tuple(found)


def work_of(
    here: Here, only: Sequence[Exercise] = (), *, warm_ups: bool = False
) -> tuple[list[StudentWork], list[FileReply]]:
    """The files to hand in, and those left out with the reason; warm-ups only on request.

    Args:
        only: these exercises and no others, whatever was started; empty for all.
    """
    chosen: list[StudentWork] = []
    left_out: list[FileReply] = []
    begun = here.workspace.begun() if warm_ups else ()
    small = (one for one in here.catalog.warm_ups() if one.id in begun)
    for exercise in only or (*here.catalog.exercises(), *small):
        there = here.workspace.path(exercise.place, exercise.module).exists()
        module = _module(here, exercise) if there else None
        notebook, why_not = _handed_in_notebook(here, exercise)
        if module is not None and is_edited(module):
            chosen.append(module)
            why_not = f"{exercise.module} was worked in too, and is handed in" if notebook else why_not
        elif notebook is not None:
            chosen.append(notebook)
        elif (other := here.unread(exercise)) or there or exercise.id in here.workspace.started():
            why = (_STUB if there else "not there") + (
                f"; {other} is not read under that name" if other else ""
            )
            left_out.append(FileReply(path=f"{exercise.place}/{exercise.module}", action=why))
        if why_not:
            path = f"{exercise.place}/{_notebook_name(exercise)}"
            left_out.append(FileReply(path=path, action=why_not))
    return chosen, left_out


_STUB = "still the stub"


def _notebook_name(exercise: Exercise) -> str:
    return Path(exercise.module).with_suffix(NOTEBOOK).name


# -- the two kinds of files ----------------------------------------------------------------------------------


def _module(here: Here, exercise: Exercise) -> StudentWork:
    source = here.source(exercise)
    notes = _unread(here, exercise, exercise.module)
    return StudentWork(exercise, exercise.module, source, source, here.stub(exercise), notes=notes)


def _unread(here: Here, exercise: Exercise, name: str) -> tuple[str, ...]:
    """A note on work that is not read because of its file's name, if there is some."""
    other = here.unread(exercise)
    said = f"{exercise.place}/{other} is not read: the file that counts is {name}."
    return (said,) if other else ()


def _notebook(here: Here, exercise: Exercise) -> StudentWork:
    """The notebook as it lies in the workspace.

    Raises:
        UngradableError: it is missing, is not a notebook, or has none of the exercise's functions.
        UsageError: it cannot be read.
    """
    from course.handed_in.notebook import notebook_source
    from course.notebooks.build import exercise_notebook

    name = _notebook_name(exercise)
    path = here.workspace.path(exercise.place, name)
    if not path.exists():
        problem = f"There is no file {here.workspace.shown(path)}."
        fix = f"`course notebook build {exercise.id}` puts one there."
        raise UngradableError(problem, help=fix, code="no_file")
    data = read_notebook(path)
    module = notebook_source(data, exercise, name)
    must_fit(len(module.source), f"The code of {name} is")
    given = notebook_source(exercise_notebook(here.catalog, exercise), exercise)
    notes = _unread(here, exercise, name)
    return StudentWork(exercise, name, data, module.source, given.source, module, notes)


def is_edited(work: StudentWork) -> bool:
    """Whether a file is not as it was handed out; where no record says how that was, as it would be now."""
    if work.notebook is None:
        return not same_text(work.stub, work.data)
    return not is_untouched(work.data) and fingerprint(work.source) != fingerprint(work.stub)


def _beside_notebook(here: Here, module: StudentWork) -> StudentWork:
    """An edited module, with a note if the notebook beside it has other code."""
    try:
        notebook = _notebook(here, module.exercise)
    except CourseError:
        return module  # `submit` says what is wrong with it
    if not is_edited(notebook) or fingerprint(notebook.source) == fingerprint(module.source):
        return module
    note = (
        f"{notebook.path} was worked in too and holds other code; {module.path} is what counts and was read. "
        f"To have the notebook checked: course check {notebook.path}"
    )
    return replace(module, notes=(*module.notes, note))


# -- as they are handed in -----------------------------------------------------------------------------------


def _handed_in_notebook(here: Here, exercise: Exercise) -> tuple[StudentWork | None, str]:
    """The notebook to hand in; or None and the reason, "" where there is none."""
    from course.handed_in.notebook import notebook_source

    if not here.workspace.path(exercise.place, _notebook_name(exercise)).exists():
        return None, ""
    try:
        notebook = _notebook(here, exercise)
    except CourseError as problem:
        return None, problem.message.rstrip(".")
    if not is_edited(notebook):
        return None, _STUB
    try:
        small = _without_outputs(notebook.data)
    except (ValueError, RecursionError):
        return None, "its outputs cannot be read; clear them in Jupyter and save it again"
    if len(small) > MAX_FILE:
        return None, f"larger than {MAX_FILE:,} bytes without its outputs, which no grading run takes"
    # As a grading run reads it: from the bytes that go into the archive alone.
    return replace(notebook, data=small, notebook=notebook_source(small, exercise, notebook.name)), ""


def _without_outputs(data: bytes) -> bytes:
    notebook = json.loads(data.decode("utf-8-sig"))
    sheets = [notebook, *notebook.get("worksheets", [])]
    for cell in (cell for sheet in sheets for cell in sheet.get("cells", [])):
        cell.pop("attachments", None)
        if cell.get("cell_type") == "code":
            cell["outputs"], cell["execution_count"] = [], None
    return dumped(notebook)

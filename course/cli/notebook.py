"""``course notebook``: the course in Jupyter, and notebooks checked like files."""

import contextlib
import shlex
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import msgspec

from course.browser import invite
from course.catalog.load import Catalog
from course.catalog.models import CourseRef, Exercise
from course.cli.frame.console import Console, current
from course.cli.frame.here import cwd, find_workspace, here_or_outside, load_catalog, named, write
from course.cli.frame.options import Verbose, argument, choice_of, exercise_ids, notebook_ids, option
from course.cli.frame.registry import COMMANDS, group
from course.cli.frame.replies import Backup, Envelope
from course.cli.work.checking import Check, reply_to
from course.cli.work.verdict import show_verdict
from course.errors import NotFoundError, UngradableError, UsageError
from course.extras import require
from course.handed_in import attempts
from course.handed_in.limits import read_notebook
from course.handed_in.notebook import code_cells, notebook_source
from course.notebooks import server
from course.notebooks.build import FOLDERS, NBGRADER, WORKSPACE, Generated, Layout, generate
from course.notebooks.merge import CannotMergeError, is_untouched, merged
from course.printable import counted
from course.progress.workspace import write_atomically

# ---
# The replies of ``course notebook ... --json``, as types.


class NotebookFile(msgspec.Struct, frozen=True, kw_only=True):
    """One notebook and what was done.

    ``action`` is "written" (there was none), "current" (nothing newer), "replaced" (the student had written
    nothing in it), "merged" (the newer one with the student's work in it), "beside" (``new`` is the newer
    one, ``path`` as it was, ``reason`` why) or, from ``course open``, "kept" (there was one; it was not
    opened).
    """

    kind: str
    id: str
    path: str
    action: str
    new: str | None = None
    reason: str = ""
    backup: Backup | None = None


class Notebook(Envelope, tag="course.notebook/1", frozen=True, kw_only=True):
    """``build`` and ``update``."""

    course: CourseRef
    folder: str
    files: tuple[NotebookFile, ...]


class NotebookOpen(Envelope, tag="course.open/1", frozen=True, kw_only=True):
    """``course open``, printed once ``address`` works; the command goes on until it is ended."""

    course: CourseRef
    folder: str
    files: tuple[NotebookFile, ...]
    address: str


class NotebookCheck(Envelope, tag="course.notebook-check/1", frozen=True, kw_only=True):
    """``check``: ``result`` is what ``course check`` gives, with cells for lines."""

    file: str
    result: Check


def _exercise(catalog: Catalog, path: Path, data: bytes, wanted: str | None) -> Exercise:
    """A notebook's exercise: the given one, or the one that its cells, its name or its functions show."""
    if wanted is not None:
        return catalog.exercise(wanted)
    exercises = catalog.exercises()
    marks = [cell.tags.get("exercise") for cell in code_cells(data, path.name)]
    found = [one for one in exercises if one.id in marks]
    found += [one for one in exercises if path.stem == one.id or f"{path.stem}.py" == one.module]
    if found:
        return found[0]
    for exercise in exercises:
        with contextlib.suppress(UngradableError):
            notebook_source(data, exercise)
            return exercise
    problem = f"{path.name} does not say which exercise it is about, and defines no function of any."
    raise NotFoundError(problem, help="Say which with --exercise.", code="which_exercise")


# ---
# Notebooks on disk. Students' work is never overwritten, and a copy of every replaced file is kept.


def place(out: Path | None) -> tuple[Path, Layout]:
    """The folder that notebooks go into, and where in it each lies."""
    if out is not None:
        return named(out), FOLDERS
    here = find_workspace()
    return (cwd() / "notebooks", FOLDERS) if here is None else (here.workspace.root, WORKSPACE)


def put(folder: Path, notebook: Generated, *, update: bool = True) -> NotebookFile:
    """Write a notebook, or bring an existing one up to date.

    Args:
        update: an existing one; False leaves it alone, whatever it holds.

    Raises:
        UsageError: the existing file cannot be read, or no copy of it can be kept.
        MissingCapabilityError: the folder cannot be written.
    """
    path = folder / notebook.path
    said = partial(NotebookFile, kind=notebook.kind, id=notebook.id, path=str(path))
    if not path.exists():
        write_atomically(path, notebook.data)
        return said(action="written")
    if not update:
        return said(action="kept")
    old = read_notebook(path)
    try:
        data = merged(old, notebook.data)
    except CannotMergeError as problem:
        beside = path.with_name(f"{path.stem}.new{path.suffix}")
        written = write(beside, notebook.data, why="notebook")
        return said(action="beside", new=str(beside), reason=str(problem), backup=written.backup)
    if data == old:
        return said(action="current")
    action = "replaced" if is_untouched(old) else "merged"
    return said(action=action, backup=write(path, data, why="notebook").backup)


app = group(COMMANDS["notebook"].summary)

FORMATS = ("jupyter", "nbgrader")
Ids = Annotated[
    list[str] | None,
    argument("[ID]...", "Lessons, exercises, quiz or sandbox; everything if left out.", notebook_ids),
]
Out = Annotated[
    Path | None, option("--out DIR", "Where; if left out, the workspace, and outside of one notebooks/.")
]


@app.command(epilog="Example: course notebook build numerical-integration integrators")
def build(
    ids: Ids = None,
    out: Out = None,
    executed: Annotated[
        bool, option("--executed", "Run each one first, so that it opens with its outputs.")
    ] = False,
    form: Annotated[
        str, option("--format FORMAT", "jupyter, or nbgrader for an nbgrader site.", choice_of(*FORMATS))
    ] = "jupyter",
) -> int:
    """Write notebooks.

    Work in an existing notebook is kept: newer text is put around it, or the newer notebook beside it.
    """
    console = current()
    if form not in FORMATS:
        raise UsageError(f"--format {form}: known are {' and '.join(FORMATS)}.", code="unknown_format")
    if form == "nbgrader":
        return _build_nbgrader(console, ids or [], out, executed=executed)
    if executed:
        require("notebook", "nbclient", "ipykernel", what="--executed")
    catalog = load_catalog()
    folder, layout = place(out)
    notebooks: Iterable[Generated] = generate(catalog, ids or [], layout)
    if executed:
        notebooks = (_executed(console, notebook) for notebook in notebooks)
    return _write(console, catalog, folder, notebooks)


@app.command(epilog="Example: course notebook update")
def update(ids: Ids = None, out: Out = None) -> int:
    """Bring existing notebooks up to date.

    Your work stays: cells you edited and cells you added. Where newer text cannot be put around it, the
    newer notebook is put beside yours as NAME.new.ipynb. A copy of every replaced file is kept.
    """
    console, catalog = current(), load_catalog()
    folder, layout = place(out)
    there = list(generate(catalog, ids or [], layout, there=folder))
    if not there:
        problem = f"There is no notebook of the course in {folder}."
        raise NotFoundError(problem, help="`course notebook build` writes them.", code="no_notebooks")
    return _write(console, catalog, folder, there)


@app.command(epilog="Example: course notebook check integrators/integrators.ipynb")
def check(
    file: Annotated[Path, argument("FILE", "A notebook with an exercise's functions.")],
    exercise: Annotated[
        str | None,
        option("--exercise EXERCISE", "Which exercise, if the notebook does not say it.", exercise_ids),
    ] = None,
    verbose: Verbose = False,
) -> int:
    """Run the public checks on a notebook.

    Runs the functions of the notebook, as a grading run does, not the notebook itself. Exit code 0 if every
    check passes, 1 if one does not, 3 if nothing could be checked.
    """
    console, path = current(), named(file)
    if not path.exists():
        problem = f"There is no file {file}."
        raise NotFoundError(problem, help="`course notebook build` writes notebooks.", code="no_file")
    data = read_notebook(path)
    here, catalog = here_or_outside()
    chosen = _exercise(catalog, path, data, exercise)
    module = notebook_source(data, chosen, file.name)
    with console.working(f"Checking {chosen.id}"):
        made = attempts.attempt(chosen, catalog, module.submission(chosen))
    if here is not None and path.is_relative_to(here.workspace.root):
        here.record("check", chosen.id, made.data(catalog.version))
    if made.problem is not None:
        raise made.problem
    show_verdict(console, chosen, made.verdict, verbose=verbose)
    reply = reply_to(catalog.ref, made.verdict, f"course notebook check {file}")
    return (here or console).answer(NotebookCheck(exit_code=reply.exit_code, file=str(path), result=reply))


def _build_nbgrader(console: Console, ids: list[str], out: Path | None, *, executed: bool) -> int:
    from course.notebooks.magic import nbgrader_notebook

    if executed:
        problem = "--format nbgrader --executed: nbgrader runs notebooks itself."
        raise UsageError(problem, help="Leave one of the two out.", code="executed_nbgrader")
    catalog = load_catalog()
    exercises = [catalog.exercise(name) for name in ids] if ids else list(catalog.exercises())
    notebooks = (
        Generated("nbgrader", one.id, NBGRADER.exercise(one), nbgrader_notebook(catalog, one))
        for one in exercises
    )
    folder = named(out or "nbgrader")
    code = _write(console, catalog, folder, notebooks)
    console.note(
        "The score that counts is `course grade run`'s: in nbgrader a student's code can forge its own."
    )
    return code


def _executed(console: Console, notebook: Generated) -> Generated:
    with console.working(f"Running {notebook.path}"):
        return replace(notebook, data=server.executed(notebook.data, str(notebook.path)))


def _write(console: Console, catalog: Catalog, folder: Path, notebooks: Iterable[Generated]) -> int:
    """Put every notebook where it belongs, and say what was done."""
    files = []
    for notebook in notebooks:
        files.append(put(folder, notebook))
        console.line(_sentence(folder, files[-1]))
    changed = sum(file.action != "current" for file in files)
    only = "new or changed" if changed else "not changed"
    new = only if len(files) == 1 else f"{changed} of them new or changed"
    console.line((f"{counted(len(files), 'notebook')} in {folder}, {new}.", "bold"))
    lab = f"Open them with: {shlex.join(['jupyter', 'lab', str(folder)])}"
    other = "Open them in any program for Jupyter notebooks; `course open` needs JupyterLab."
    console.note(lab if find_spec("jupyterlab") else other)
    return console.answer(Notebook(course=catalog.ref, folder=str(folder), files=tuple(files)))


def _sentence(folder: Path, file: NotebookFile) -> str:
    def shown(path: str) -> str:
        full = Path(path)
        return full.relative_to(folder).as_posix() if full.is_relative_to(folder) else path

    kept = f" The old one is kept at {shown(file.backup.backup)}." if file.backup else ""
    said = {
        "written": "written.",
        "current": "up to date.",
        "replaced": "replaced by the newer one; nothing of yours was in it.",
        "merged": "newer text was put around your work.",
        "beside": f"not changed, since {file.reason}; the newer one is {shown(file.new or '')}.",
    }
    return f"{shown(file.path)}: {said[file.action]}{kept}"


# ---
# ``course open``: JupyterLab on a notebook of the course.


def open_notebook(
    wanted: Annotated[
        str | None,
        argument("[ID]", "A lesson, an exercise, quiz or sandbox; all of them if left out.", notebook_ids),
    ] = None,
    no_browser: Annotated[bool, option("--no-browser", "Only print the address; nothing is opened.")] = False,
) -> int:
    """Open one notebook in JupyterLab.

    A missing notebook is written first, in the workspace, or outside of one in notebooks/. An existing one is
    not changed: `course notebook update` brings newer text. Ctrl+C ends it.
    """
    console = current()
    require("notebook", "jupyterlab", "ipykernel", what="Opening a notebook")
    catalog = load_catalog()
    folder, layout = place(None)
    files = [put(folder, one, update=False) for one in generate(catalog, [wanted] if wanted else [], layout)]
    shown = Path(files[0].path) if wanted else folder
    relative = shown.relative_to(folder).as_posix() if wanted else ""
    with contextlib.suppress(KeyboardInterrupt), contextlib.ExitStack() as stack:
        with console.working("Starting JupyterLab"):
            lab = stack.enter_context(server.started(folder, relative))
        console.line(f"{shown} is at {lab.address}")
        invite(lab.address, console.note, show=not no_browser)
        console.emit(
            NotebookOpen(course=catalog.ref, folder=str(folder), files=tuple(files), address=lab.address)
        )
        console.flush()  # whoever reads a file or a pipe needs the address now
        lab.wait()
    return 0

"""``course notebook``: the course in Jupyter, and notebooks checked like files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from course.cli.frame.completion import choice_of, exercise_ids, notebook_ids
from course.cli.frame.here import cwd, load_catalog
from course.cli.frame.terminal.console import Console, current
from course.cli.notebook.checking import check_file
from course.cli.notebook.files import place, put
from course.cli.notebook.replies import Notebook
from course.errors import CourseError, NotFoundError, UsageError
from course.extras import require
from course.notebooks.build import Generated, generate
from course.notebooks.building.layout import NBGRADER
from course.notebooks.execute import executed

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.catalog.load import Catalog
    from course.cli.notebook.replies import NotebookFile

__all__ = ["app", "build", "check", "update"]

app = typer.Typer(
    help="Get lessons and exercises as Jupyter notebooks.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

FORMATS = ("jupyter", "nbgrader")
Ids = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[ID]...",
        help="Lessons, exercises, quiz or sandbox; everything if left out.",
        autocompletion=notebook_ids,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Where; if left out, the workspace, and outside of one notebooks/."
    ),
]


@app.command(epilog="Example: course notebook build numerical-integration integrators")
def build(
    ids: Ids = None,
    out: Out = None,
    executed: Annotated[
        bool, typer.Option("--executed", help="Run each one first, so that it opens with its outputs.")
    ] = False,
    form: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="FORMAT",
            help="jupyter, or nbgrader for an nbgrader site.",
            autocompletion=choice_of(*FORMATS),
        ),
    ] = "jupyter",
) -> int:
    """Write notebooks.

    Work in an existing notebook is kept: newer text is put around it, or the newer notebook beside it.
    """
    console = current()
    if form not in FORMATS:
        raise UsageError(f"--format {form}: there is {' and '.join(FORMATS)}.", code="unknown_format")
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
    there = [
        notebook for notebook in generate(catalog, ids or [], layout) if (folder / notebook.path).exists()
    ]
    if not there:
        raise NotFoundError(
            f"There is no notebook of the course in {folder}.",
            help="`course notebook build` writes them.",
            code="no_notebooks",
        )
    return _write(console, catalog, folder, there)


@app.command(epilog="Example: course notebook check integrators/integrators.ipynb")
def check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A notebook with an exercise's functions.")],
    exercise: Annotated[
        str | None,
        typer.Option(
            "--exercise",
            metavar="EXERCISE",
            help="Which exercise, if the notebook does not say it.",
            autocompletion=exercise_ids,
        ),
    ] = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Show tracebacks and all that your code printed.")
    ] = False,
) -> int:
    """Run the public checks on a notebook.

    Runs the functions of the notebook, as a grading run does, not the notebook itself. Exit code 0 if every
    check passes, 1 if one does not, 3 if nothing could be checked.
    """

    return check_file(current(), file, exercise, verbose=verbose)


# -- writing ---------------------------------------------------------------------------------------------


def _build_nbgrader(console: Console, ids: list[str], out: Path | None, *, executed: bool) -> int:
    from course.notebooks.nbgrader import nbgrader_notebook

    if executed:
        raise UsageError(
            "--format nbgrader --executed: nbgrader runs notebooks itself.",
            help="Leave one of the two out.",
            code="executed_nbgrader",
        )
    catalog = load_catalog()
    exercises = [catalog.exercise(name) for name in ids] if ids else list(catalog.exercises())
    notebooks = (
        Generated("nbgrader", one.id, NBGRADER.exercise(one), nbgrader_notebook(catalog, one))
        for one in exercises
    )
    folder = cwd() / (out.expanduser() if out else Path("nbgrader"))
    code = _write(console, catalog, folder, notebooks)
    console.note(
        "The score that counts is `course grade run`'s: in nbgrader a student's code can forge its own."
    )
    return code


def _executed(console: Console, notebook: Generated) -> Generated:
    from dataclasses import replace

    with console.working(f"Running {notebook.path}"):
        return replace(notebook, data=executed(notebook.data, str(notebook.path)))


def _write(console: Console, catalog: Catalog, folder: Path, notebooks: Iterable[Generated]) -> int:
    """Put every notebook where it belongs, and say what was done."""
    files = []
    for notebook in notebooks:
        try:
            files.append(put(folder, notebook))
        except OSError as error:
            raise CourseError(f"{folder / notebook.path}: {error.strerror or error}.") from error
        console.line(_sentence(folder, files[-1]))
    changed = sum(file.action != "current" for file in files)
    count = "1 notebook" if len(files) == 1 else f"{len(files)} notebooks"
    new = f"{changed} of them new or changed"
    if len(files) == 1:
        new = "new or changed" if changed else "not changed"
    console.line((f"{count} in {folder}, {new}.", "bold"))
    console.note(f"Open them with: jupyter lab {folder}")
    console.emit(
        Notebook(
            course=catalog.ref,
            folder=str(folder),
            files=tuple(files),
        )
    )
    return 0


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

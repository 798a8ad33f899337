"""``course open``: JupyterLab on a notebook of the course."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Annotated

import typer

from course.browser import invite
from course.cli.frame.completion import notebook_ids
from course.cli.frame.here import load_catalog
from course.cli.frame.terminal.console import current
from course.cli.notebook.files import place, put
from course.cli.notebook.replies import NotebookOpen
from course.extras import require
from course.notebooks.build import generate

__all__ = ["open_notebook"]


def open_notebook(
    wanted: Annotated[
        str | None,
        typer.Argument(
            metavar="[ID]",
            help="A lesson, an exercise, quiz or sandbox; all of them if left out.",
            autocompletion=notebook_ids,
        ),
    ] = None,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Only print the address; nothing is opened.")
    ] = False,
) -> int:
    """Open a notebook in JupyterLab.

    A missing notebook is written first, in the workspace, or outside of one in notebooks/. An existing one is
    not changed: `course notebook update` brings newer text. Ctrl+C ends it.
    """
    from course.notebooks.server import started

    console = current()
    require("notebook", "jupyterlab", "ipykernel", what="Opening a notebook")
    catalog = load_catalog()
    folder, layout = place(None)
    files = [put(folder, one, update=False) for one in generate(catalog, [wanted] if wanted else [], layout)]
    shown = Path(files[0].path) if wanted else folder
    relative = shown.relative_to(folder).as_posix() if wanted else ""
    with contextlib.suppress(KeyboardInterrupt), contextlib.ExitStack() as stack:
        with console.working("Starting JupyterLab"):
            lab = stack.enter_context(started(folder, relative))
        console.line(f"{shown} is at {lab.address}")
        invite(lab.address, console.note, show=not no_browser)
        console.emit(
            NotebookOpen(course=catalog.ref, folder=str(folder), files=tuple(files), address=lab.address)
        )
        console.flush()  # whoever reads a file or a pipe needs the address now
        lab.wait()
    return 0

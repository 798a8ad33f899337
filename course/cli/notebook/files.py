"""Notebooks on disk. Students' work is never overwritten, and a copy of every replaced file is kept."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from course.cli.frame.files import write
from course.cli.frame.here import cwd, find_workspace
from course.cli.notebook.replies import NotebookFile
from course.handed_in.cells import read_notebook
from course.notebooks.building.layout import FOLDERS, WORKSPACE
from course.notebooks.building.merge import CannotMergeError, is_untouched, merged
from course.progress.workspace import write_atomically

if TYPE_CHECKING:
    from pathlib import Path

    from course.notebooks.build import Generated
    from course.notebooks.building.layout import Layout

__all__ = ["place", "put"]


def place(out: Path | None) -> tuple[Path, Layout]:
    """The folder that notebooks go into, and where in it each lies."""
    if out is not None:
        return cwd() / out.expanduser(), FOLDERS
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

"""Notebooks on disk. Nothing somebody wrote is overwritten, and whatever is replaced is kept as a copy."""

from __future__ import annotations

from functools import partial
from pathlib import Path  # noqa: TC003 - functions here take paths, and annotations are read
from typing import TYPE_CHECKING

from course.errors import UsageError

if TYPE_CHECKING:
    from course.cli.notebook_schemas import NotebookFile
    from course.notebooks.build import Generated

__all__ = ["put", "read"]


def put(folder: Path, notebook: Generated) -> NotebookFile:
    """Write a notebook, or bring the one that is there up to date.

    Raises:
        UsageError: what is there cannot be read, or no copy of it can be kept.
        MissingCapabilityError: the folder cannot be written.
    """
    from course.cli.notebook_schemas import NotebookFile
    from course.cli.sim_files import write
    from course.notebooks.merge import CannotMergeError, is_untouched, merged
    from course.progress.workspace import write_atomically

    path = folder / notebook.path
    said = partial(NotebookFile, kind=notebook.kind, id=notebook.id, path=str(path))
    if not path.exists():
        write_atomically(path, notebook.data)
        return said(action="written")
    old = read(path)
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


def read(path: Path) -> bytes:
    """A notebook's file.

    Raises:
        UsageError: it is a folder, too large, or cannot be read.
    """
    from course.grading.notebook_cells import MAX_NOTEBOOK

    try:
        if not path.is_file():
            raise UsageError(f"{path} is not a file.", help="Name a notebook.", code="not_a_file")
        if path.stat().st_size > MAX_NOTEBOOK:
            raise UsageError(
                f"{path} is larger than {MAX_NOTEBOOK >> 20} MB.",
                help="Clear its outputs and save it.",
                code="too_large",
            )
        return path.read_bytes()
    except OSError as error:
        raise UsageError(
            f"{path} cannot be read ({error.strerror or error}).", help="Check its permissions."
        ) from error

"""Runs a generated notebook in a fresh kernel, so that it opens with its outputs."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from course.errors import InternalError
from course.extras import require
from course.notebooks.building.cells import dumped
from course.notebooks.sandbox import STILL

__all__ = ["environment", "executed"]

#: Wall seconds that one cell may take. The slowest in the course takes about three on an idle machine.
_PATIENCE = 600


def executed(data: bytes, name: str) -> bytes:
    """The notebook with the outputs of a run from top to bottom.

    No times are recorded, so on one machine the same notebook gives the same bytes.

    Args:
        data: a notebook the course generated.
        name: what to call it in messages.

    Raises:
        MissingCapabilityError: there is nothing to run it with.
        InternalError: a cell raises.
    """
    require("notebook", "nbclient", "ipykernel")
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    read: Any = nbformat.reads
    notebook = read(data.decode(), as_version=4)
    with tempfile.TemporaryDirectory(prefix="course-notebook-") as folder:
        client = NotebookClient(
            notebook,
            timeout=_PATIENCE,
            kernel_name="python3",
            record_timing=False,
            resources={"metadata": {"path": folder}},
        )
        try:
            # A kernel's own log is of no use to the user here.
            client.execute(env=environment() | {STILL: "1"}, stderr=subprocess.DEVNULL)
        except CellExecutionError as error:
            raise InternalError(
                f"A cell of {name} raises {error.ename}: {error.evalue[:300]}",
                help="Generate it without --executed, and run it in Jupyter to see where.",
                code="cell_raised",
            ) from None
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
    return dumped(notebook)


def environment() -> dict[str, str]:
    """This process's environment, in which the course is found even if it is not installed."""
    here = str(Path(__file__).resolve().parents[2])
    given = os.environ.get("PYTHONPATH")
    path = f"{given}{os.pathsep}{here}" if given else here
    return os.environ | {"PYTHONPATH": path}

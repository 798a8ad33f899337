"""JupyterLab on a folder, for one person at this machine."""

import contextlib
import json
import os
import secrets
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any
from urllib.parse import quote, urlencode, urlsplit

from course.errors import CourseError, InternalError
from course.extras import require
from course.notebooks.cells import dumped
from course.notebooks.sandbox import STILL
from course.printable import printable

# ---
# Runs a generated notebook in a fresh kernel, so that it opens with its outputs.


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


#: How often to look whether it has started, in s.
_LOOK = 0.1
#: How much of its output is shown if it does not start, in characters.
_SAID = 2000
#: How long it may take to shut down its kernels before it is killed, in s.
_GRACE = 20
#: Runs the module it is given. Left to itself, jsonschema compiles the grammar of internationalised addresses
#: while JupyterLab starts, which is a third of the start; nothing there checks one.
RUN_MODULE = (
    "import runpy, sys; sys.modules['rfc3987_syntax'] = None; "
    "runpy.run_module(sys.argv.pop(1), run_name='__main__', alter_sys=True)"
)


@dataclass
class Lab:
    """A running JupyterLab.

    Attributes:
        address: opens the page in a browser; it holds the access token.
    """

    address: str
    _process: subprocess.Popen[bytes]

    def wait(self) -> int:
        """Wait until it ends; returns its exit code."""
        return self._process.wait()


@contextlib.contextmanager
def started(folder: Path, path: str = "") -> Iterator[Lab]:
    """Start JupyterLab and wait until it answers; it ends with the context. It opens no browser.

    Args:
        folder: what its file browser shows.
        path: the notebook in that folder to open.

    Raises:
        MissingCapabilityError: the extra ``notebook`` is not installed.
        CourseError: it ended before it was ready.
    """
    require("notebook", "jupyterlab", "ipykernel", what="Opening a notebook")
    page = f"/lab/tree/{quote(path)}" if path else "/lab"
    token = secrets.token_hex(24)
    # Ctrl+C reaches it as well as this process, so it must not ask again. A browser of its own choice would
    # start without a display, too, and take over this terminal.
    command = [sys.executable, "-c", RUN_MODULE, "jupyterlab", "-y", "--no-browser"]
    command += [f"--ServerApp.root_dir={folder}", f"--ServerApp.default_url={page}"]
    # A user who works as root, as in containers, chose to.
    command += ["--allow-root"] if getattr(os, "geteuid", lambda: 1)() == 0 else []
    # In the environment, not on the command line, which every user of the machine can read.
    secret = environment() | {"JUPYTER_TOKEN": token}
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(command, env=secret, cwd=folder, stdout=subprocess.DEVNULL, stderr=log)
        try:
            yield Lab(_address(process, token, page, log), process)
        finally:
            _ended(process)


def _address(process: subprocess.Popen[bytes], token: str, page: str, log: IO[bytes]) -> str:
    """Wait until the server answers at the address in its file; each running server writes one."""
    from jupyter_core.paths import jupyter_runtime_dir

    runtime = Path(jupyter_runtime_dir())
    while process.poll() is None:
        for file in runtime.glob("jpserver-*.json"):
            about = _read(file)
            if (about.get("pid") == process.pid or about.get("token") == token) and _answers(about["url"]):
                query = f"?{urlencode({'token': about['token']})}" if about.get("token") else ""
                return str(about["url"]).rstrip("/") + page + query
        time.sleep(_LOOK)
    raise CourseError(
        f"JupyterLab ended before it was ready (exit code {process.returncode}).",
        help=f"`jupyter lab` in this folder starts it without the course. It said:\n{_end_of(log)}",
        code="jupyter_ended",
    )


def _answers(url: str) -> bool:
    """Whether the server listens yet: its file is written a moment earlier."""
    parts = urlsplit(url)
    try:
        socket.create_connection((parts.hostname, parts.port or 80), timeout=_LOOK).close()
    except OSError:
        return False
    return True


def _end_of(log: IO[bytes]) -> str:
    log.seek(0)
    return printable(log.read().decode("utf-8", "replace")[-_SAID:].strip())


def _read(file: Path) -> dict[str, Any]:
    try:
        about = json.loads(file.read_text("utf-8"))
    except (OSError, ValueError):  # gone, another user's, or still being written
        return {}
    return about if isinstance(about, dict) else {}


def _ended(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(_GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()

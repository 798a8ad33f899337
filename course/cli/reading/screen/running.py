"""What goes on beside the page while its reader reads on: cells run, tasks are checked, figures are drawn.

Each has a process of its own and a thread that waits for it; both end with the reader.
"""

from __future__ import annotations

import base64
import contextlib
import json
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import msgspec
from rich.text import Text

from course.browser import opened
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.cli.frame.pictures import half_blocks
from course.errors import CourseError, MissingCapabilityError
from course.isolation.failures import IsolationError
from course.progress.history import history_of
from course.progress.store import numbered
from course.progress.workspace import Workspace, write_atomically
from course.reading.parts import Cell
from course.reading.record import InProgress

if TYPE_CHECKING:  # it needs NumPy, and no first page waits for that
    from course.reading.cells import CellOutput, CellRunner

# ---
# A lesson's cells, one at a time.


class Bench:
    """Where the cells of one lesson run.

    Args:
        progress: the lesson.
        done: called in the cells' thread with the cell, the code that ran and its result.
    """

    def __init__(
        self, progress: InProgress, done: Callable[[Cell, str, CellOutput], object] = lambda *_: None
    ) -> None:
        self._progress = progress
        self._done = done
        self._runner: CellRunner | None = None
        self._pool: ThreadPoolExecutor | None = None
        self._since = 0.0
        self._stopped = False
        self.cell: Cell | None = None

    def start(self, cell: Cell) -> Future[CellOutput] | None:
        """Run a cell, which will give its result; None if one is running already."""
        if self.cell is not None:
            return None
        self.cell, self._since, self._stopped = cell, perf_counter(), False
        return self._submit(self._run, cell, self._progress.cell(cell).source)

    def prepare(self) -> None:
        """Start the process ahead, so that the first cell need not wait for it."""
        if self._pool is None:
            self._submit(self._warm)

    def interrupt(self) -> None:
        self._stopped = True
        if self._runner is not None:
            self._runner.interrupt()

    def busy(self) -> tuple[str, str]:
        """The key of the cell that runs and what to say of it; empty if none does."""
        if self.cell is None:
            return "", ""
        return self.cell.key, f"runs, {self._waited:.0f} s; Ctrl-C stops it"

    @property
    def _waited(self) -> float:
        return perf_counter() - self._since

    def close(self) -> None:
        """Stop the cell that runs, and end its process."""
        self.interrupt()
        if self._pool is not None:
            # In their own thread: the cells' process dies with the thread that started it.
            self._pool.submit(self._end)
            self._pool.shutdown(wait=True)
            self._pool = None

    def _end(self) -> None:
        with contextlib.suppress(IsolationError):  # it ended by itself
            if self._runner is not None:
                self._runner.close()

    def _submit(self, what: Callable[..., Any], *arguments: object) -> Future[Any]:
        if self._pool is None:
            self._pool = ThreadPoolExecutor(1, thread_name_prefix="cells", initializer=_hear_no_ctrl_c)
        return self._pool.submit(what, *arguments)

    def _ready(self) -> CellRunner:
        """In the cells' thread: their process, started."""
        from course.reading.cells import CellRunner

        if self._runner is None:
            progress = self._progress
            self._runner = CellRunner(progress.script.cells, lambda one: progress.cell(one).source)
        self._runner.prepare()
        return self._runner

    def _warm(self) -> None:
        with contextlib.suppress(IsolationError):  # the first run says it
            self._ready()

    def _run(self, cell: Cell, source: str) -> CellOutput:
        from course.reading.cells import STOPPED, CellOutput

        try:
            runner = self._ready()
            # A stop while the process is still starting is meant for the cell; that time was shown as its.
            gave = CellOutput("", STOPPED, self._waited) if self._stopped else runner.run(cell)
        except IsolationError as error:
            gave = CellOutput("", f"The cell could not be run: {error}.", self._waited)
        self.cell = None
        self._done(cell, source, gave)
        return gave


def _hear_no_ctrl_c() -> None:
    """Ctrl-C on a terminal reaches every process there; those that this thread starts are not meant."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


def write_cell(progress: InProgress, cell: Cell) -> Path:
    """Write a cell's code into a file of the current folder; an existing one keeps its name and content.

    Raises:
        MissingCapabilityError: the folder cannot be written.
    """
    for path in numbered(Path(f"{progress.script.lesson.id}-{cell.number}.py")):
        try:
            with contextlib.suppress(FileExistsError), path.open("x", encoding="utf-8") as file:
                file.write(progress.cell(cell).source + "\n")
                break
        except OSError as error:
            problem = f"{path} cannot be written ({error.strerror or error})."
            fix = "Change to a folder that can be written."
            raise MissingCapabilityError(problem, help=fix, code="not_writable") from error
    return path


# ---
# Warm-ups and exercises done while their lesson is read: their files, and the results of their checks.
#
# ``course check`` and ``course hint`` run in a separate process: the reader stays small, the file is the one
# that an editor has open, and the same code as everywhere writes the record.


#: Time limit of a command, in s; the checks' own deadlines are shorter.
_PATIENCE = 120.0


@dataclass(frozen=True, slots=True)
class Standing:
    """How far the student is with one task.

    Attributes:
        file: where it lies, relative to the workspace; empty before it was started.
        done: all its checks passed once.
        busy: what is going on; empty if nothing is.
        reply: the last answer of ``course check --json``, as plain values.
        hint: what ``course hint`` said last.
        fixed: functions that the check before found wrong and this one right.
    """

    file: str = ""
    done: bool = False
    busy: str = ""
    reply: dict[str, Any] | None = None
    hint: str = ""
    fixed: tuple[str, ...] = ()


def _text(data: bytes) -> str:
    """A file as an editor shows it."""
    return data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n")


class Practice:
    """The warm-ups and exercises of a course in one workspace.

    Args:
        workspace: None outside of one, where nothing can be started.

    Attributes:
        changed: called with an id, from another thread, when its standing has changed.
    """

    def __init__(self, catalog: Catalog, workspace: Workspace | None) -> None:
        self.changed: Callable[[str], object] = lambda _: None
        self._catalog = catalog
        self._workspace = workspace
        self._standings: dict[str, Standing] = {}
        self._saved: dict[str, int] = {}
        self._opened: dict[str, bytes] = {}
        self._thread: threading.Thread | None = None
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def possible(self) -> bool:
        """Whether there is a workspace to work in."""
        return self._workspace is not None

    @property
    def busy(self) -> bool:
        return any(one.busy for one in self._standings.values())

    def of(self, name: str) -> Standing:
        """How far the student is."""
        if name in self._standings or self._workspace is None:
            return self._standings.get(name, Standing())
        exercise, done = self._catalog.exercise(name), False
        with contextlib.suppress(CourseError):
            done = history_of(self._workspace.store.events("check", name)).done is not None
        file = f"{exercise.place}/{exercise.module}" if self._path(exercise).is_file() else ""
        self._standings[name] = Standing(file=file, done=done)
        return self._standings[name]

    def start(self, name: str) -> None:
        """Put its file into the workspace where there is none.

        Raises:
            MissingCapabilityError: the workspace cannot be written.
        """
        if self._workspace is None:
            return
        exercise = self._catalog.exercise(name)
        for path in exercise.given:
            self._workspace.give(exercise.place, path.name, path.read_bytes())
        self._workspace.store.append("start", name, {"version": self._catalog.version})
        self._saved[name] = self._stamp(exercise)
        self._standings[name] = replace(self.of(name), file=f"{exercise.place}/{exercise.module}")

    def source(self, name: str) -> str:
        """The code in its file, to be changed; ``write`` knows then what was opened."""
        self._opened[name] = self._path(self._catalog.exercise(name)).read_bytes()
        return _text(self._opened[name])

    def write(self, name: str, source: str) -> str:
        """Put other code into its file. What was saved there since it was opened is not lost.

        Returns:
            What became of it; empty where nobody else saved it.

        Raises:
            MissingCapabilityError: the workspace cannot be written.
        """
        exercise, opened = self._catalog.exercise(name), self._opened[name]
        path, told = self._path(exercise), ""
        if self._workspace is not None:
            self._workspace.must_be_there()
        now = path.read_bytes() if path.is_file() else opened
        if source == _text(opened):  # nothing was typed
            return "" if now == opened else "It was saved elsewhere meanwhile, and stays as it is there."
        if self._workspace is not None and (now != opened or "\ufffd" in _text(now)):
            copy = self._workspace.shown(self._workspace.backup(path, "editor"))
            what = "What was saved there meanwhile" if now != opened else "What was there, which is no UTF-8,"
            told = f"{what} is in {copy}."
        write_atomically(path, source.encode())
        self._opened[name] = source.encode()
        self._saved[name] = self._stamp(exercise)
        return told

    def was_saved(self, name: str) -> bool:
        """Whether the student's editor saved the file since the last call."""
        if not self.of(name).file:
            return False
        stamp = self._stamp(self._catalog.exercise(name))
        before = self._saved.setdefault(name, stamp)
        self._saved[name] = stamp
        return stamp not in {before, 0}

    def ask(self, name: str, command: str) -> bool:
        """Do what ``course check`` or ``course hint`` does; False if something is going on already."""
        if self.busy:
            return False
        what = "Checking" if command == "check" else "Asking"
        self._standings[name] = replace(self.of(name), busy=what)
        self._thread = threading.Thread(target=self._work, args=(name, command), name="practice")
        self._thread.start()
        return True

    def close(self) -> None:
        if self._process is not None:
            self._process.kill()
        if self._thread is not None:
            self._thread.join()

    def _work(self, name: str, command: str) -> None:
        """In a thread: the command's answer."""
        reply = self._reply(name, command)
        now = replace(self._standings[name], busy="")
        if command == "hint" and "error" not in reply:
            hint = reply.get("hint")
            now = replace(now, hint=f"Hint: {hint}" if hint else str(reply.get("message", "")))
        else:
            fixed: tuple[str, ...] = ()
            with contextlib.suppress(CourseError):  # the functions that the last edit fixed, by the record
                if self._workspace is not None and "error" not in reply:
                    history = history_of(self._workspace.store.events(subject=name))
                    fixed = tuple(sorted(history.changed_tasks()[0]))
            now = replace(now, reply=reply, hint="", done=now.done or bool(reply.get("ok")), fixed=fixed)
        self._standings[name] = now
        self.changed(name)

    def _reply(self, name: str, command: str) -> dict[str, Any]:
        assert self._workspace is not None
        line = [sys.executable, "-P", "-m", "course", "-C", str(self._workspace.root)]
        with subprocess.Popen(
            [*line, command, name, "--json"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        ) as self._process:
            try:
                said, _ = self._process.communicate(timeout=_PATIENCE)
                reply: dict[str, Any] = msgspec.json.decode(said)
            except (subprocess.TimeoutExpired, msgspec.DecodeError):
                self._process.kill()
                reply = {"error": {"message": f"`course {command} {name}` gave no answer.", "help": ""}}
        self._process = None
        return reply

    def _path(self, exercise: Exercise) -> Path:
        assert self._workspace is not None
        return self._workspace.path(exercise.place, exercise.module)

    def _stamp(self, exercise: Exercise) -> int:
        """When the file was last saved; 0 where it is gone."""
        with contextlib.suppress(OSError):
            return self._path(exercise).stat().st_mtime_ns
        return 0


# ---
# Figures as half blocks of a terminal. Drawing needs matplotlib, which is slow to load and large; the reader
# stays quick and small without it.


#: A figure's height, in cells, as a share of its width; its caption stands below it on the same screen.
_LOW = 0.26
_CAPTION = 5
_LEAST = 8
#: Lines of a finding with its hint.
_FINDING = 11


class Drawer:
    """Draws figures, one after the other; each is drawn once for a size.

    Attributes:
        drawn: called with the name of what is there now, from another thread.
    """

    def __init__(self) -> None:
        self.drawn: Callable[[str], object] = lambda _: None
        self._drawn: dict[tuple[str, int, int], list[Text]] = {}
        self._asked: set[tuple[str, int, int]] = set()
        self._waiting: dict[int, Callable[[dict[str, Any]], None]] = {}
        self._process: subprocess.Popen[str] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._number = 0

    def rows(self, name: str, curve: dict[str, Any] | None, columns: int, room: int) -> list[Text]:
        """A picture's lines; blank ones while it is being drawn, so that nothing moves when it arrives.

        Args:
            name: of a figure, or of the task whose check failed.
            curve: one of ``course check --json``, to be drawn over the right one; None for a figure.
            columns: how wide.
            room: lines of a screen; a figure and the start of its caption fit, a curve and its finding.
        """
        rows = max(_LEAST, min(round(columns * _LOW), room - (_FINDING if curve else _CAPTION)))
        request: dict[str, Any] = {"curve": curve} if curve else {"figure": name}
        key = (json.dumps(request), columns, rows)
        if key not in self._asked:
            self._asked.add(key)

            def take(answer: dict[str, Any]) -> None:
                if "pixels" in answer:
                    pixels = base64.b64decode(answer["pixels"])
                    self._drawn[key] = half_blocks(pixels, columns, rows, answer["labels"])
                else:
                    self._drawn[key] = []  # it stays described
                self.drawn(name)

            self._ask({**request, "columns": columns, "rows": rows}, take)
        return self._drawn.get(key, [Text()] * rows)

    def open(self, figure: str, say: Callable[[str], object]) -> None:
        """Show a figure as on paper in the system's viewer, or say where its file is."""

        def take(answer: dict[str, Any]) -> None:
            if "png" not in answer:
                say(answer.get("error", "The figure could not be drawn."))
                return
            if self._folder is None:
                self._folder = tempfile.TemporaryDirectory(prefix="course-figures-")
            path = Path(self._folder.name) / f"{figure}.png"
            path.write_bytes(base64.b64decode(answer["png"]))
            shown = opened(path.as_uri())
            say(f"Opened {figure}.png" if shown else f"No viewer here; until you leave, the figure is {path}")

        self._ask({"figure": figure, "png": True}, take)

    def close(self) -> None:
        if self._process is not None:
            with contextlib.suppress(OSError), self._process:  # which closes its streams and waits for it
                self._process.kill()
            self._process = None
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def _ask(self, request: dict[str, Any], take: Callable[[dict[str, Any]], None]) -> None:
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "course.figures.terminal"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                encoding="utf-8",
            )
            threading.Thread(target=self._listen, args=(self._process,), name="figures", daemon=True).start()
        self._number += 1
        self._waiting[self._number] = take
        assert self._process.stdin is not None
        with contextlib.suppress(OSError, ValueError):  # it ended: figures stay described
            self._process.stdin.write(json.dumps({**request, "id": self._number}) + "\n")
            self._process.stdin.flush()

    def _listen(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with contextlib.suppress(OSError, ValueError):  # closed on the way out
            for line in process.stdout:
                answer = json.loads(line)
                self._waiting.pop(answer["id"])(answer)

"""Warm-ups done while their lesson is read: their files, and what their checks say.

A warm-up is checked and hinted at by the command itself, in a process of its own: the reader stays small, the
file is the one that an editor has open, and the record is written by the one who writes it everywhere.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import msgspec

from course.errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import ThreadPoolExecutor
    from pathlib import Path

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.progress.workspace import Workspace

__all__ = ["Practice", "Standing"]

#: A command that takes longer hangs; checks have deadlines of their own below this. In s.
_PATIENCE = 120.0


@dataclass(frozen=True, slots=True)
class Standing:
    """How far the student is with one warm-up.

    Attributes:
        file: where it lies, relative to the workspace; empty before it was started.
        done: all its checks passed once.
        busy: what goes on now; empty if nothing does.
        reply: the last answer of ``course check --json``, as plain values.
        hint: what ``course hint`` said last.
    """

    file: str = ""
    done: bool = False
    busy: str = ""
    reply: dict[str, Any] | None = None
    hint: str = ""


class Practice:
    """The warm-ups of a course in one workspace.

    Args:
        workspace: None outside of one, where nothing can be started.

    Attributes:
        changed: called with an id, from another thread, when its standing has changed.
    """

    def __init__(self, catalog: Catalog, workspace: Workspace | None) -> None:
        self.changed: Callable[[str], None] = lambda _: None
        self._catalog = catalog
        self._workspace = workspace
        self._standings: dict[str, Standing] = {}
        self._saved: dict[str, int] = {}
        self._pool: ThreadPoolExecutor | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False

    @property
    def possible(self) -> bool:
        """Whether there is a workspace to work in."""
        return self._workspace is not None

    def of(self, warm_up: str) -> Standing:
        """How far the student is."""
        if warm_up not in self._standings:
            self._standings[warm_up] = self._recorded(warm_up)
        return self._standings[warm_up]

    def start(self, warm_up: str) -> None:
        """Put its file into the workspace where there is none.

        Raises:
            MissingCapabilityError: the workspace cannot be written.
        """
        if self._workspace is None:
            return
        exercise = self._catalog.exercise(warm_up)
        for path in (exercise.readme_path, exercise.stub_path):
            self._workspace.give(exercise.place, path.name, path.read_bytes())
        self._workspace.store.append("start", warm_up, {"version": self._catalog.version})
        self._saved[warm_up] = self._stamp(exercise)
        self._standings[warm_up] = replace(self.of(warm_up), file=f"{exercise.place}/{exercise.module}")

    def source(self, warm_up: str) -> str:
        """Its file as it is now."""
        return self._path(self._catalog.exercise(warm_up)).read_text(encoding="utf-8", errors="replace")

    def write(self, warm_up: str, source: str) -> None:
        """Put other code into its file.

        Raises:
            MissingCapabilityError: the workspace cannot be written.
        """
        from course.progress.workspace import write_atomically

        exercise = self._catalog.exercise(warm_up)
        write_atomically(self._path(exercise), source.encode())
        self._saved[warm_up] = self._stamp(exercise)

    def was_saved(self, warm_up: str) -> bool:
        """Whether the file was saved since this was asked last, by an editor of the student's."""
        if not self.of(warm_up).file:
            return False
        stamp = self._stamp(self._catalog.exercise(warm_up))
        before = self._saved.setdefault(warm_up, stamp)
        self._saved[warm_up] = stamp
        return stamp not in {before, 0}

    def check(self, warm_up: str) -> bool:
        """Check it, as ``course check`` does; False if something is going on already."""
        return self._run(warm_up, "check", "Checking")

    def hint(self, warm_up: str) -> bool:
        """Ask for the hint that is due, as ``course hint`` does; False if something is going on already."""
        return self._run(warm_up, "hint", "Asking")

    def close(self) -> None:
        """End what runs."""
        self._closed = True
        if self._process is not None:
            self._process.kill()
        if self._pool is not None:
            self._pool.shutdown(wait=True)
            self._pool = None

    # -- inside ----------------------------------------------------------------------------------------

    def _run(self, warm_up: str, command: str, what: str) -> bool:
        if any(one.busy for one in self._standings.values()):
            return False
        if self._pool is None:
            from concurrent.futures import ThreadPoolExecutor

            self._pool = ThreadPoolExecutor(1, thread_name_prefix="practice")
        self._standings[warm_up] = replace(self.of(warm_up), busy=what)
        self._pool.submit(self._ask, warm_up, command)
        return True

    def _ask(self, warm_up: str, command: str) -> None:
        """In the pool's thread: the command's answer."""
        reply = self._reply(warm_up, command)
        now = replace(self._standings[warm_up], busy="")
        if command == "hint" and "error" not in reply:
            hint = reply.get("hint")
            now = replace(now, hint=f"Hint: {hint}" if hint else str(reply.get("message", "")))
        else:
            now = replace(now, reply=reply, hint="", done=now.done or bool(reply.get("ok")))
        self._standings[warm_up] = now
        if not self._closed:
            self.changed(warm_up)

    def _reply(self, warm_up: str, command: str) -> dict[str, Any]:
        assert self._workspace is not None
        line = [sys.executable, "-P", "-m", "course", "-C", str(self._workspace.root)]
        with subprocess.Popen(
            [*line, command, warm_up, "--json"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        ) as self._process:
            try:
                said, _ = self._process.communicate(timeout=_PATIENCE)
                reply: dict[str, Any] = msgspec.json.decode(said)
            except (subprocess.TimeoutExpired, msgspec.DecodeError):
                self._process.kill()
                problem = {"message": f"`course {command} {warm_up}` gave no answer.", "help": ""}
                reply = {"error": problem}
        self._process = None
        return reply

    def _recorded(self, warm_up: str) -> Standing:
        """What the workspace knows of a warm-up."""
        if self._workspace is None:
            return Standing()
        exercise = self._catalog.exercise(warm_up)
        try:
            events = self._workspace.store.events("check", warm_up)
        except CourseError:
            events = ()
        there = self._path(exercise).is_file()
        done = any(event.data.get("all_pass") and not event.data.get("only") for event in events)
        return Standing(file=f"{exercise.place}/{exercise.module}" if there else "", done=done)

    def _path(self, exercise: Exercise) -> Path:
        assert self._workspace is not None
        return self._workspace.path(exercise.place, exercise.module)

    def _stamp(self, exercise: Exercise) -> int:
        """When the file was last saved; 0 where it is gone."""
        try:
            return self._path(exercise).stat().st_mtime_ns
        except OSError:
            return 0

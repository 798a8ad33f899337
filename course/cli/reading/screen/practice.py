"""Warm-ups and exercises done while their lesson is read: their files, and the results of their checks.

``course check`` and ``course hint`` run in a separate process: the reader stays small, the file is the one
that an editor has open, and the same code as everywhere writes the record.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import msgspec

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.errors import CourseError
from course.progress.workspace import Workspace

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


class Practice:
    """The warm-ups and exercises of a course in one workspace.

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

    @property
    def busy(self) -> bool:
        """Whether something is being checked, or asked."""
        return any(one.busy for one in self._standings.values())

    def of(self, name: str) -> Standing:
        """How far the student is."""
        if name not in self._standings:
            self._standings[name] = self._recorded(name)
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
        """Its file as it is now."""
        return self._path(self._catalog.exercise(name)).read_text(encoding="utf-8", errors="replace")

    def write(self, name: str, source: str) -> None:
        """Put other code into its file.

        Raises:
            MissingCapabilityError: the workspace cannot be written.
        """
        from course.progress.workspace import write_atomically

        exercise = self._catalog.exercise(name)
        write_atomically(self._path(exercise), source.encode())
        self._saved[name] = self._stamp(exercise)

    def was_saved(self, name: str) -> bool:
        """Whether the student's editor saved the file since the last call."""
        if not self.of(name).file:
            return False
        stamp = self._stamp(self._catalog.exercise(name))
        before = self._saved.setdefault(name, stamp)
        self._saved[name] = stamp
        return stamp not in {before, 0}

    def check(self, name: str) -> bool:
        """Check it, as ``course check`` does; False if something is going on already."""
        return self._run(name, "check", "Checking")

    def hint(self, name: str) -> bool:
        """Ask for the hint that is due, as ``course hint`` does; False if something is going on already."""
        return self._run(name, "hint", "Asking")

    def close(self) -> None:
        """End what runs."""
        self._closed = True
        if self._process is not None:
            self._process.kill()
        if self._pool is not None:
            self._pool.shutdown(wait=True)
            self._pool = None

    # -- inside ----------------------------------------------------------------------------------------

    def _run(self, name: str, command: str, what: str) -> bool:
        if self.busy:
            return False
        if self._pool is None:
            from concurrent.futures import ThreadPoolExecutor

            self._pool = ThreadPoolExecutor(1, thread_name_prefix="practice")
        self._standings[name] = replace(self.of(name), busy=what)
        self._pool.submit(self._ask, name, command)
        return True

    def _ask(self, name: str, command: str) -> None:
        """In the pool's thread: the command's answer."""
        reply = self._reply(name, command)
        now = replace(self._standings[name], busy="")
        if command == "hint" and "error" not in reply:
            hint = reply.get("hint")
            now = replace(now, hint=f"Hint: {hint}" if hint else str(reply.get("message", "")))
        else:
            fixed = () if "error" in reply else self._fixed(name)
            now = replace(now, reply=reply, hint="", done=now.done or bool(reply.get("ok")), fixed=fixed)
        self._standings[name] = now
        if not self._closed:
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
                problem = {"message": f"`course {command} {name}` gave no answer.", "help": ""}
                reply = {"error": problem}
        self._process = None
        return reply

    def _fixed(self, name: str) -> tuple[str, ...]:
        """The functions that the last edit fixed, by the record."""
        from course.progress.history import history_of

        assert self._workspace is not None
        try:
            return tuple(sorted(history_of(self._workspace.store.events(subject=name)).changed_tasks()[0]))
        except CourseError:
            return ()

    def _recorded(self, name: str) -> Standing:
        """The workspace's record of a task."""
        if self._workspace is None:
            return Standing()
        exercise = self._catalog.exercise(name)
        try:
            events = self._workspace.store.events("check", name)
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

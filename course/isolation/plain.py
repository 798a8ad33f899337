"""L1, on any system: a plain process per worker."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.isolation import launch
from course.isolation.deadline import ProcessClock
from course.isolation.failures import IsolationError
from course.isolation.inside.frames import LOOK
from course.isolation.levels import MAX_OUTPUT, Exit, Level, ticking

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.isolation.levels import Handle, Limits
    from course.isolation.view import View

__all__ = ["ProcessSpawner"]


class ProcessSpawner:
    """Any system: a plain process per worker, the next one started ahead so that a restart costs no wait."""

    def __init__(self, view: View, imports: tuple[str, ...], limits: Limits) -> None:
        self.level = Level.L1
        self._folder = launch.private_folder()
        launch.copy_worker_files(self._folder)
        self._view = view
        self._imports = imports
        self._limits = limits
        self._standby: _ProcessHandle | None = None
        self._left: list[Iterator[None]] = []  # removals of folders of workers that ended

    def _start(self) -> _ProcessHandle:
        workdir = Path(tempfile.mkdtemp(dir=self._folder))
        packages = sorted({str(entry.parent) for entry in self._view.packages})
        config: dict[str, Any] = {
            "level": "L1",
            "imports": list(self._imports),
            "limits": vars(self._limits),
            "path": [str(self._folder), *packages],
            "workdir": str(workdir),
        }
        ours, theirs = socket.socketpair()
        with theirs:
            return _ProcessHandle(ours, theirs, self._view, str(self._folder), config, workdir, self._left)

    def spawn(self) -> Handle:
        handle, self._standby = self._standby, None
        if handle is not None and not handle.alive():
            # It ended with the thread that started it, because Linux takes that thread for its parent.
            handle.finish()
            handle = None
        handle = handle or self._start()
        try:
            self._standby = self._start()
        except OSError as error:
            handle.finish()
            raise IsolationError(f"a worker process could not be started: {error}") from None
        return handle

    def tidy(self) -> None:
        launch.tidy(self._left)

    def close(self) -> None:
        if self._standby is not None:
            self._standby.finish()
            self._standby = None
        launch.sweep(self._folder)


class _ProcessHandle:
    """A worker that is a plain child process."""

    def __init__(
        self,
        ours: socket.socket,
        theirs: socket.socket,
        view: View,
        folder: str,
        config: dict[str, Any],
        workdir: Path,
        left: list[Iterator[None]],
    ) -> None:
        self.channel = self._socket = ticking(ours)
        self._left = left
        self._workdir = workdir
        # Opened twice and at once: later the student's code may have put anything under that name.
        with (workdir / ".output").open("wb") as output:
            self._output = (workdir / ".output").open("rb")
            streams: dict[str, Any] = {"stdout": output, "stderr": output, "env": launch.environment()}
            if sys.platform == "win32":
                self._process = self._start_windows(theirs, view, folder, config, streams)
            else:
                self._process = subprocess.Popen(
                    launch.command(view, folder, {**config, "control": theirs.fileno()}),
                    pass_fds=(theirs.fileno(),),
                    start_new_session=True,
                    stdin=subprocess.DEVNULL,
                    **streams,
                )

        clock = ProcessClock(self._process.pid)
        self.cpu_s, self.asleep = clock.cpu_s, clock.asleep

    @staticmethod
    def _start_windows(
        theirs: socket.socket, view: View, folder: str, config: dict[str, Any], streams: dict[str, Any]
    ) -> subprocess.Popen[bytes]:
        # A socket cannot be inherited there; it is shared with the child by its process id, over stdin.
        shared_size = len(theirs.share(os.getpid()))  # type: ignore[attr-defined]
        command = launch.command(view, folder, {**config, "share": shared_size})
        process = subprocess.Popen(command, stdin=subprocess.PIPE, **streams)
        assert process.stdin is not None
        process.stdin.write(theirs.share(process.pid))  # type: ignore[attr-defined]
        process.stdin.close()
        return process

    def alive(self) -> bool:
        return self._process.poll() is None

    def output(self) -> str:
        if self._output.closed:
            return ""
        self._output.seek(0)
        return self._output.read(MAX_OUTPUT).decode("utf-8", "replace")

    def look(self) -> None:
        if LOOK is not None:
            self._process.send_signal(LOOK)

    def finish(self) -> Exit:
        if hasattr(os, "killpg"):  # not on Windows
            # What it started goes with it, also if it ended by itself; until it is waited for, its number
            # cannot have become another's.
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        code = self._process.wait()
        self._socket.close()
        self._output.close()
        self._left.append(launch.removing(self._workdir))
        return Exit(max(code, 0), max(-code, 0))

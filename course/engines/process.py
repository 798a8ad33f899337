"""Starts an engine in its own process, sends it jobs, and survives its failures."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

#: How long an engine may take to load, s: usually 0.1 to 0.6, several times that from a cold disk.
START_S = 60.0
#: Every engine runs on one processor core: rates can be compared, and sums do not depend on the order of
#: threads.
_ONE_THREAD = {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
_LAST_WORDS = 200


class EngineProcess:
    """One engine's process; a context manager. It starts with the first job, and again after it has died.

    Args:
        engine: its id.
        command: run in place of the worker, for tests.
    """

    def __init__(self, engine: str, command: list[str] | None = None) -> None:
        self.engine = engine
        self._command = command or [sys.executable, "-P", "-m", "course.engines.worker", engine]
        self._process: subprocess.Popen[str] | None = None
        self._lines: queue.Queue[str | None] = queue.Queue()
        self._words: Any = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def pid(self) -> int | None:
        """The process's id, if there is one."""
        return self._process.pid if self._process else None

    def ask(self, job: Mapping[str, Any], seconds: float) -> dict[str, Any]:
        """The reply to a job, or a reply that says why there is none.

        Args:
            seconds: to wait at most; then the process is ended.
        """
        if self._process is None:
            started = self._start()
            if started["status"] != "ok":
                return started
        process = self._process
        if process is None or process.stdin is None:
            return {"status": "failed", "message": "The process could not be started."}
        try:
            process.stdin.write(json.dumps({**job, "seconds": seconds}) + "\n")
            process.stdin.flush()
        except OSError:
            return self._died()
        return self._read(seconds)

    def _start(self) -> dict[str, Any]:
        self._lines = queue.Queue()
        self._words = tempfile.TemporaryFile()  # noqa: SIM115 - closed in close()
        root = str(Path(__file__).parents[2])
        path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
        try:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._words,
                text=True,
                encoding="utf-8",
                env={**os.environ, **_ONE_THREAD, "PYTHONPATH": path},
            )
        except OSError as error:
            self._words.close()
            return {"status": "unavailable", "message": f"No process could be started ({error.strerror})."}
        threading.Thread(target=_pump, args=(self._process, self._lines), daemon=True).start()
        reply = self._read(START_S)
        if reply["status"] != "ok":
            self.close()
            if reply["status"] == "crash":
                return {"status": "unavailable", "message": reply["message"]}
        return reply

    def _read(self, seconds: float) -> dict[str, Any]:
        try:
            line = self._lines.get(timeout=seconds)
        except queue.Empty:
            self.close()
            return {"status": "deadline", "message": f"No answer within {seconds:g} s; it was ended."}
        if line is None:
            return self._died()
        try:
            reply: dict[str, Any] = json.loads(line)
        except ValueError:
            self.close()
            return {"status": "crash", "message": "Its answer was not one."}
        return reply

    def _died(self) -> dict[str, Any]:
        """The message about a process that ended by itself."""
        process, code = self._process, None
        if process is not None:
            try:
                code = process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                process.kill()
                code = process.wait()
        how = f"It ended with exit code {code}."
        if code is not None and code < 0:
            try:
                how = f"It was ended by {signal.Signals(-code).name}."
            except ValueError:
                how = f"It was ended by signal {-code}."
        words = self._last_words()
        self.close()
        return {"status": "crash", "message": f"{how} {words}".strip()}

    def _last_words(self) -> str:
        if self._words is None or self._words.closed:
            return ""
        self._words.seek(0, os.SEEK_END)
        self._words.seek(max(0, self._words.tell() - 4096))
        lines = self._words.read().decode("utf-8", errors="replace").splitlines()
        said = [line.strip() for line in lines if line.strip()]
        return f"Its last words: {said[-1][:_LAST_WORDS]}" if said else ""

    def close(self) -> None:
        """End the process, if there is one."""
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    # What could not be flushed to a dead process is lost anyway.
                    with contextlib.suppress(OSError):
                        pipe.close()
        if self._words is not None:
            self._words.close()


def _pump(process: subprocess.Popen[str], lines: queue.Queue[str | None]) -> None:
    """Move replies from the pipe to the queue; None at the end."""
    # The pipe may be closed while it is read: the end, too.
    with contextlib.suppress(OSError, ValueError):
        for line in process.stdout or ():
            lines.put(line)
    lines.put(None)

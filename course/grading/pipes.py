"""Frames on the pipes between our own processes: a 4-byte little-endian length, then msgpack.

Also the life of such a process, which ends with the one that started it, and, where it reads untrusted files,
its limits and its replacement.
"""

import _thread
import contextlib
import os
import queue
import signal
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from time import process_time
from typing import IO, Any

import msgspec

from course.errors import InternalError

try:
    import resource
except ImportError:  # Windows has none of these limits
    resource = None  # type: ignore[assignment]

_LENGTH = struct.Struct("<I")
#: Wall seconds that a process has to clean up after the one it worked for is gone.
_LAST_S = 3.0
#: Wall seconds that a process may take to start beside those for a question, and between two looks at it.
_START_S, _TICK_S = 60.0, 0.5


def read_frame(source: IO[bytes], most: int | None = None) -> bytes | None:
    """The next frame's content; None at the end of the stream, or if it is longer than ``most`` bytes."""
    header = source.read(_LENGTH.size)
    if len(header) < _LENGTH.size:
        return None
    size = _LENGTH.unpack(header)[0]
    if most is not None and size > most:
        return None
    body = source.read(size)
    return body if len(body) == size else None


def write_frame(sink: IO[bytes], message: Any) -> None:
    body = msgspec.msgpack.encode(message)
    sink.write(_LENGTH.pack(len(body)) + body)
    sink.flush()


def served(source: IO[bytes]) -> Iterator[bytes]:
    """The frames of a pipe, one after the other, as long as the process at its other end lives.

    A thread reads them. Whoever started this process may be killed while a frame is worked on, which can take
    minutes: then the work is interrupted (``KeyboardInterrupt`` in the main thread), and a little later this
    process ends in any case.
    """
    waiting: queue.Queue[bytes | None] = queue.Queue()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where it was started with that ignored

    def read() -> None:
        while (frame := read_frame(source)) is not None:
            waiting.put(frame)
        at_work = waiting.unfinished_tasks
        waiting.put(None)
        if at_work:
            if hasattr(signal, "pthread_kill"):  # which also ends a wait for a worker's answer
                signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
            else:
                _thread.interrupt_main()
            time.sleep(_LAST_S)
            os._exit(1)

    threading.Thread(target=read, daemon=True).start()
    while (frame := waiting.get()) is not None:
        yield frame
        waiting.task_done()


class Servant:
    """A process that answers questions; started when it is first needed, and again after one killed it.

    It writes a frame when it is ready, then answers each frame with one.

    Args:
        module: its program.
        arguments: of that program.
        wall_s: seconds after which it is killed over a question.
    """

    #: How often it is started, should it die before it is ready, and what is said if it always does.
    tries = 1
    cannot_start = "The process that reads submissions does not start; see what it printed."

    def __init__(self, module: str, *arguments: str, wall_s: float) -> None:
        self._command = [module, *arguments]
        self._wall_s = wall_s
        self._process: subprocess.Popen[bytes] | None = None
        self._over = False

    def ask(self, question: Any, most: int | None = None) -> bytes | None:
        """Its answer; None if it died over the question, took too long, or says more than ``most`` bytes.

        Raises:
            InternalError: it does not start.
        """
        frame = self._said(self._process or self._start(), question, most)
        if frame is None:
            self.close()
        return frame

    def _start(self) -> subprocess.Popen[bytes]:
        for _ in range(self.tries):
            if self._over:
                break
            process = self._process = self._launch()
            if self._said(process) is not None:
                return process
            self.close()
        raise InternalError(self.cannot_start)

    def _launch(self) -> subprocess.Popen[bytes]:
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
        environment["PYTHONPATH"] = path_with(Path(__file__).resolve().parents[2])
        return launched(*self._command, environment=environment)

    def _said(
        self, process: subprocess.Popen[bytes], question: Any = None, most: int | None = None
    ) -> bytes | None:
        """What a process says to a question, or first of all; None once it is dead.

        One that takes too long, or was stopped, is killed.
        """
        until = time.monotonic() + self._wall_s + (_START_S if question is None else 0.0)
        heard = threading.Event()

        def watch() -> None:
            while not heard.wait(_TICK_S):
                if self._over or time.monotonic() > until or _is_stopped(process.pid):
                    process.kill()  # its pipes close

        threading.Thread(target=watch, daemon=True).start()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            with contextlib.suppress(OSError):  # it died: reading from it will say so
                if question is not None:
                    write_frame(process.stdin, question)
            return read_frame(process.stdout, most)
        finally:
            heard.set()

    def end(self) -> None:
        """Have the thread that waits for an answer wait no longer, and start no other process."""
        self._over = True
        process = self._process
        if process is not None:
            process.kill()

    def close(self, patience_s: float = 0.0) -> None:
        """End the process, which has so many seconds to clean up; the next question starts another one."""
        process, self._process = self._process, None
        if process is None:
            return
        with process:
            with contextlib.suppress(OSError):
                if process.stdin:
                    process.stdin.close()  # it ends at end of file, its sandbox with it
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(patience_s)
            process.kill()


def launched(module: str, *arguments: str, environment: Mapping[str, str]) -> subprocess.Popen[bytes]:
    """A program of ours, spoken to through its pipes."""
    return subprocess.Popen(
        # -P: the folder the command is run in, which may be a student's, never becomes importable.
        [sys.executable, "-P", "-m", module, *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=environment,
        start_new_session=True,  # Ctrl-C is for whoever asks, which ends it
    )


def _is_stopped(pid: int) -> bool:
    """Whether a signal stopped that process: a submission at L1 may send one, and nothing would wake it."""
    if not hasattr(os, "waitid"):
        return False
    with contextlib.suppress(ChildProcessError):
        return os.waitid(os.P_PID, pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT) is not None
    return False


def path_with(folder: Path) -> str:
    """This process's ``PYTHONPATH`` with a folder before all others."""
    return os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))


def limit_memory(size: int) -> None:
    """Limit this process's memory from now on, in bytes; it leaves no core file either."""
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_AS, (size, size))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def limit_cpu(seconds: int) -> None:
    """End this process once it has used so much more CPU time than by now; a later call begins anew."""
    if resource is not None:
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (int(process_time()) + seconds + 1, hard))

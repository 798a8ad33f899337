"""What students hand in, read in a process of its own that can be ended.

Notebooks and archives are parsed there, under limits of CPU time, memory, wall time and of what it may
answer; nothing of them is ever run. A file that exceeds one costs itself: it is named and cannot be graded.
``python -m course.grading.intake.reading`` is the process; it answers frames of msgpack.
"""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import msgspec

from course.errors import InternalError, UngradableError
from course.grading.intake.archives import RefusedError, manifest_of, module_in
from course.grading.pipes import read_frame, write_frame
from course.handed_in.notebook import notebook_source
from course.printable import one_line
from course.scoring.verdict import Problem

if TYPE_CHECKING:
    from course.catalog.models import Exercise

__all__ = ["Reader", "reader"]

#: For one file. The largest notebook that may be handed in takes about 3 s of CPU, ten thousand lines of code
#: less than one; a busy machine may take six times as long by the wall clock.
CPU_S, WALL_S = 10, 60.0
MEMORY = 1 << 30
#: Of an answer, in bytes: a module and what is noted of it.
MAX_ANSWER = 4 << 20


class _Ask(msgspec.Struct, frozen=True):
    """One file to read, and what is looked for in it.

    Attributes:
        kind: "notebook", "archive" or "quiz".
        path: of an archive.
        content: of a notebook.
        name: what to call it in messages.
    """

    kind: str
    name: str
    path: bytes = b""
    content: bytes = b""
    exercise: str = ""
    module: str = ""
    tasks: tuple[str, ...] = ()


class _Told(msgspec.Struct, frozen=True):
    """What was found: a file by its name and content, or why there is none; both None if it is not there."""

    problem: Problem | None = None
    name: str | None = None
    content: bytes = b""
    record: bytes = b""


@dataclass(frozen=True)
class _Limits:
    cpu_s: int = CPU_S
    wall_s: float = WALL_S
    memory: int = MEMORY


class Reader:
    """A process that reads; started when it is first needed, and again when a file ended it."""

    def __init__(self, limits: _Limits = _Limits()) -> None:
        self._limits = limits
        self._process: subprocess.Popen[bytes] | None = None

    def notebook(self, content: bytes, exercise: Exercise, name: str) -> tuple[bytes, bytes]:
        """The module that a notebook stands for, and the record of its cells.

        Raises:
            RefusedError: it is none that can be graded.
        """
        told = self._ask(_Ask("notebook", one_line(name), content=content, **_wanted(exercise)))
        return told.content, told.record

    def module_in(self, path: Path, exercise: Exercise) -> tuple[str, bytes] | None:
        """What an archive holds for an exercise: name and content; None if nothing.

        Raises:
            RefusedError: it must not be opened, or is damaged.
        """
        told = self._ask(
            _Ask("archive", one_line(path.name), path=os.fsencode(path.absolute()), **_wanted(exercise))
        )
        return None if told.name is None else (told.name, told.content)

    def quiz_in(self, path: Path) -> Any:
        """The quiz attempts in an archive, as JSON gave them; None if it holds none.

        Raises:
            RefusedError: it must not be opened, or is damaged.
        """
        told = self._ask(_Ask("quiz", one_line(path.name), path=os.fsencode(path.absolute())))
        return json.loads(told.content)

    def close(self) -> None:
        """End the process; the next file starts another one."""
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):
                if stream is not None:
                    stream.close()

    def _ask(self, ask: _Ask) -> _Told:
        process = self._process or self._start()
        assert process.stdin is not None
        assert process.stdout is not None
        too_long = threading.Timer(self._limits.wall_s, process.kill)
        too_long.start()
        try:
            write_frame(process.stdin, ask)
            frame = read_frame(process.stdout, MAX_ANSWER)
        except OSError:
            frame = None
        finally:
            too_long.cancel()
        if frame is None:
            self.close()
            raise RefusedError(
                "unreadable",
                f"{ask.name} takes more time or memory to read than any honest file.",
                "Hand in the .py file, or a notebook of ordinary size.",
            )
        told = msgspec.msgpack.decode(frame, type=_Told)
        if told.problem is not None:
            problem = told.problem
            raise RefusedError(problem.code, problem.message, problem.help)
        return told

    def _start(self) -> subprocess.Popen[bytes]:
        """The process, when it says that it is ready.

        Raises:
            InternalError: it does not start.
        """
        package = str(Path(__file__).resolve().parents[3])
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, (package, environment.get("PYTHONPATH"))))
        limits = self._limits
        process = self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", __name__, str(limits.cpu_s), str(limits.memory)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            start_new_session=True,  # Ctrl-C is for the run, which ends it
        )
        assert process.stdout is not None
        if read_frame(process.stdout, MAX_ANSWER) is None:
            self.close()
            raise InternalError("The process that reads submissions does not start; see what it printed.")
        return process


#: The one of this process: a run reads one file after the other.
reader = Reader()
atexit.register(reader.close)


def _wanted(exercise: Exercise) -> dict[str, Any]:
    tasks = tuple(task.id for task in exercise.task)
    return {"exercise": exercise.id, "module": exercise.module, "tasks": tasks}


# -- the process ------------------------------------------------------------------------------------------


def main() -> None:
    """Serve until standard input ends."""
    cpu_s, memory = int(sys.argv[1]), int(sys.argv[2])
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    with contextlib.suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    write_frame(sink, None)
    while (frame := read_frame(source)) is not None:
        with contextlib.suppress(ImportError):
            _, hard = resource.getrlimit(resource.RLIMIT_CPU)
            resource.setrlimit(resource.RLIMIT_CPU, (int(process_time()) + cpu_s + 1, hard))
        try:
            told = _answer(msgspec.msgpack.decode(frame, type=_Ask))
        except RefusedError as refused:
            told = _Told(problem=refused.problem)
        except UngradableError as error:
            told = _Told(problem=Problem(error.code, error.message, error.help))
        except MemoryError:
            os._exit(1)  # whoever asked takes it from there
        write_frame(sink, told)


def _answer(ask: _Ask) -> _Told:
    # What it is looked for by, of an exercise; the course's content is not needed to read a file.
    exercise: Any = SimpleNamespace(
        id=ask.exercise, module=ask.module, task=[SimpleNamespace(id=name) for name in ask.tasks]
    )
    if ask.kind == "notebook":
        module = notebook_source(ask.content, exercise, ask.name)
        return _Told(name=ask.name, content=module.source, record=module.record())
    path = Path(os.fsdecode(ask.path))
    if ask.kind == "quiz":
        return _Told(content=json.dumps(manifest_of(path).get("quiz")).encode())
    found = module_in(path, exercise)
    return _Told() if found is None else _Told(name=found[0], content=found[1])


if __name__ == "__main__":
    main()

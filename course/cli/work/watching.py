"""``course watch``: a verdict after every save.

The grading session stays warm between saves, so what a save costs is the checks themselves. The folder is
watched and not the file: many editors save by putting a new file in the old one's place.
"""

from __future__ import annotations

import contextlib
import signal
import threading
import time
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from course.cli.frame.arguments import ExerciseName  # noqa: TC001 - typer reads annotations at run time
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here
from course.cli.frame.replies import ErrorBody, ErrorReply, Watch, WatchRun
from course.cli.work import checking
from course.cli.work.advice import next_step
from course.cli.work.chosen import asked_for, chosen_work
from course.cli.work.verdicts import show_verdict
from course.errors import CourseError, UngradableError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.catalog.models import Exercise
    from course.cli.frame.replies import Check

__all__ = ["Watcher", "saves", "watch"]

INTERRUPTED = 130
#: The file system must be quiet this long before a save counts as done. In ms.
QUIET_MS = 20
#: A save that never ends is looked at after this long anyway. In ms.
PATIENCE_MS = 200
#: Some programs empty a file and then write it; an empty one is looked at once more after this. In s.
SECOND_LOOK = 0.05
#: How often a folder that is gone is looked for. In s.
ABSENCE_POLL = 0.2

Signature = tuple[int, int, int] | None


def watch(
    exercise: ExerciseName = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Show tracebacks and what your code printed.")
    ] = False,
) -> int:
    """Check again on every save.

    Ctrl-C ends it. With --json the one object is printed then.
    """
    from course.cli.work.checking import open_session

    console, here = current(), Here.load()
    # Nothing to watch is an error now, and only something to wait for later.
    work = chosen_work(here, *asked_for(here, exercise))
    chosen = work.exercise
    path = here.workspace.path(chosen.id, work.name)
    for note in work.notes:
        console.warn(note)
    watcher = Watcher(console=console, here=here, exercise=chosen, verbose=verbose, name=work.name)
    try:
        with _ended_like_ctrl_c(), open_session(chosen, here.catalog) as session:
            console.note(f"Watching {here.workspace.shown(path)}; Ctrl-C ends it.")
            for _ in saves(path):
                watcher.look(session)
    except KeyboardInterrupt:
        if console.fancy:
            console.blank()  # the terminal has written ^C
    console.emit(watcher.reply())
    return INTERRUPTED


@contextlib.contextmanager
def _ended_like_ctrl_c() -> Iterator[None]:
    """A closed window or a plain kill ends the watch as Ctrl-C does, so that the sandbox is cleared away."""

    def stop(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    here = threading.current_thread() is threading.main_thread()
    numbers = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name)]
    before = {number: signal.signal(number, stop) for number in numbers} if here else {}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def saves(path: Path) -> Iterator[None]:
    """Yield at once, and then whenever ``path`` or its folder may have changed, until Ctrl-C."""
    from watchfiles import watch as changes

    yield
    while True:
        if not path.parent.is_dir():
            time.sleep(ABSENCE_POLL)
            if path.parent.is_dir():
                yield
            continue
        try:
            for batch in changes(
                path.parent,
                watch_filter=lambda _, changed: Path(changed).name in {path.name, path.parent.name},
                step=QUIET_MS,
                debounce=PATIENCE_MS,
                recursive=False,
                raise_interrupt=True,
                yield_on_timeout=True,
                rust_timeout=1000,
            ):
                if batch:
                    yield
                if not path.parent.is_dir():
                    break
        except FileNotFoundError:  # it went between the look and the watch
            continue


@dataclass
class Watcher:
    """Turns saves into verdicts and remembers them.

    Attributes:
        name: of the file that is watched; "" for the exercise's module.
    """

    console: Console
    here: Here
    exercise: Exercise
    verbose: bool = False
    name: str = ""
    runs: list[WatchRun] = field(default_factory=list)
    last: Check | ErrorReply | None = None
    _seen: Signature = None
    _gone: bool = False

    def look(self, session: Any) -> bool:
        """Grade the file if it was saved since the last look; True if it was."""
        noticed = time.perf_counter()
        path = self.here.workspace.path(self.exercise.id, self.name or self.exercise.module)
        signature = _signature(path)
        if signature is None:
            if not self._gone:
                self.console.line(f"{self.here.workspace.shown(path)} is gone; waiting for it to come back.")
            self._gone, self._seen = True, None
            return False
        if signature == self._seen:
            return False
        if signature[1] == 0:
            time.sleep(SECOND_LOOK)
            signature = _signature(path)
        self._seen, self._gone = signature, False
        self._grade(session, noticed)
        return True

    def reply(self) -> Any:
        """The answer that ``--json`` prints at the end."""
        return Watch(
            ok=False,
            exit_code=INTERRUPTED,
            exercise=self.exercise.id,
            runs=tuple(self.runs),
            last=self.last,
        )

    def _grade(self, session: Any, noticed: float) -> None:
        self._announce()
        try:
            work = chosen_work(self.here, self.exercise, self.name or self.exercise.module)
            verdict = checking.grade_once(session, work.submission)
            seconds = time.perf_counter() - noticed
            checking.record_verdict(self.here, self.exercise, work.source, verdict, seconds)
            problem = checking.unlike_verdict(verdict)
            if problem is not None:
                raise problem
        except CourseError as error:
            if not isinstance(error, UngradableError):
                raise
            self._ungradable(error, noticed)
            return
        show_verdict(self.console, self.exercise, verdict, verbose=self.verbose, brief=True)
        step = next_step(self.here, self.exercise, verdict, work.source)
        if step != f"course watch {self.exercise.id}":
            self.console.note(f"Next: {step}")
        self.last = checking.reply_to(self.here.course, verdict, step)
        self._remember(verdict.state, verdict.score, verdict.max_score, verdict.passed, noticed)
        self._flush_warnings()

    def _ungradable(self, error: UngradableError, noticed: float) -> None:
        self.console.line(error.message)
        if error.help:
            self.console.line(error.help)
        body = ErrorBody(code=error.code, message=error.message, help=error.help)
        self.last = ErrorReply(schema="course.check/1", exit_code=error.exit_code, error=body)
        self._remember("ungradable", 0.0, 0.0, False, noticed)
        self._flush_warnings()

    def _remember(self, state: str, score: float, maximum: float, passed: bool, noticed: float) -> None:
        at = datetime.now(UTC).isoformat(timespec="milliseconds")
        latency = round(1000 * (time.perf_counter() - noticed), 1)
        self.runs.append(WatchRun(at, state, score, maximum, passed, latency))

    def _announce(self) -> None:
        moment = datetime.now().astimezone().strftime("%H:%M:%S")
        if self.console.fancy:
            self.console.rich().rule(f"{moment}  {self.exercise.id}", style="dim")
        else:
            self.console.note(f"Checked at {moment}: {self.exercise.id}")

    def _flush_warnings(self) -> None:
        for warning in dict.fromkeys(self.here.warnings):
            self.console.warn(warning)
        self.here.warnings.clear()
        self.console.flush()


def _signature(path: Path) -> Signature:
    """What changes when a file is saved; None if there is no file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return (status.st_mtime_ns, status.st_size, status.st_ino)

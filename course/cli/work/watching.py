"""``course watch``: a verdict after every save.

The grading session stays warm between saves, so a save costs only the checks themselves. The file is looked
at twenty times a second: one question to the file system, which works on every drive and system.
"""

from __future__ import annotations

import contextlib
import queue
import select
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from course.catalog.models import Exercise
from course.cli.frame.completion import ExerciseName, Verbose
from course.cli.frame.console import PATIENCE, Console, current
from course.cli.frame.here import Here
from course.cli.frame.replies import ErrorBody, ErrorReply
from course.cli.home.advice import hint_is_due, next_step
from course.cli.work.checking import curve_replies, reply_to, show_curve
from course.cli.work.chosen import asked_for, chosen_work
from course.cli.work.hinting import give_hint
from course.cli.work.replies import Check, Watch, WatchRun
from course.cli.work.verdict import is_unwritten, show_loading, show_verdict
from course.errors import INTERRUPTED, CourseError, UngradableError
from course.handed_in import attempts
from course.handed_in.attempts import Attempt
from course.scoring.judging.session import GradingSession
from course.scoring.verdict import Verdict

# ---
# Single key presses while a command waits or works, on a terminal only.


#: How often the thread checks whether to go on, in s.
_LOOK = 0.1


class Keys:
    """Keys that were pressed and not yet taken.

    Args:
        on_key: called, in the thread that listens, with each key.
    """

    def __init__(self, on_key: Callable[[str], None] = lambda _: None) -> None:
        self._queue: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._on_key = on_key

    def press(self, key: str) -> None:
        """Take a key."""
        self._queue.put(key)
        self._on_key(key)

    def taken(self) -> Iterator[str]:
        """The keys since the last call, oldest first."""
        with contextlib.suppress(queue.Empty):
            while True:
                yield self._queue.get_nowait()


@contextlib.contextmanager
def keys_of_terminal(on_key: Callable[[str], None]) -> Iterator[Keys | None]:
    """Keys as they are pressed, without Enter; None where the system has no such terminals.

    Ctrl-C keeps its meaning. The terminal is restored afterwards.
    """
    try:
        import termios
        import tty
    except ImportError:  # Windows
        yield None
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)
    keys, done = Keys(on_key), threading.Event()

    def listen() -> None:
        import os

        while not done.is_set():
            ready, _, _ = select.select([descriptor], [], [], _LOOK)
            if ready:
                pressed = os.read(descriptor, 64)
                if not pressed:
                    return
                for key in pressed.decode("utf-8", "ignore"):
                    keys.press(key)

    thread = threading.Thread(target=listen, name="keys", daemon=True)
    try:
        tty.setcbreak(descriptor)
        thread.start()
        yield keys
    finally:
        done.set()
        if thread.is_alive():
            thread.join()
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


#: A save counts as done once the file has not changed for this long, in ms.
QUIET_MS = 20
#: A save that never ends is checked after this long anyway, in ms.
PATIENCE_MS = 200
#: Some programs empty a file and then write it, so an empty file is looked at again after this, in s.
SECOND_LOOK = 0.05
#: How often a newer save is looked for, in s.
_GLANCE = 0.05
_LABEL_WIDTH = 9

Signature = tuple[int, int, int] | None


def watch(
    exercise: ExerciseName = None,
    verbose: Verbose = False,
) -> int:
    """Check again on every save.

    On a terminal, keys give the next hint, the next failing function, details or another run; q or Ctrl-C
    ends it. With --json the one object is printed at the end.
    """
    console, here = current(), Here.load()
    # A missing file is an error at the start; later it is something to wait for.
    work = chosen_work(here, *asked_for(here, exercise))
    chosen = work.exercise
    path = here.workspace.path(chosen.place, work.name)
    for note in work.notes:
        console.warn(note)
    watcher = Watcher(console=console, here=here, exercise=chosen, verbose=verbose, name=work.name)
    wake = threading.Event()
    try:
        with (
            attempts.open_session(chosen, here.catalog) as session,
            _keys(console, wake) as keys,
        ):
            shown = here.workspace.shown(path)
            console.note(f"Watching {shown}; {'Ctrl-C ends it' if keys is None else 'q ends it'}.")
            for _ in saves(path) if keys is None else saves(path, wake):
                told = False
                for key in keys.taken() if keys is not None else ():
                    if key == "q":
                        return 0
                    told |= watcher.press(key, session)
                if watcher.look(session) or told:
                    # The first line of a watch is off the screen by now.
                    if keys is not None:
                        console.note((f"Waiting for a save of {shown}. Keys: {watcher.keys}.", "dim"))
                    console.flush()
    except KeyboardInterrupt:
        if console.fancy:
            console.blank()  # the terminal has written ^C
    console.emit(watcher.reply())
    return INTERRUPTED


@contextlib.contextmanager
def _keys(console: Console, wake: threading.Event) -> Iterator[Keys | None]:
    """Keys, if a user is there to press them."""
    if not (console.fancy and console.interactive) or console.quiet:
        yield None
        return
    with keys_of_terminal(lambda _: wake.set()) as keys:
        yield keys


def saves(path: Path, wake: threading.Event | None = None) -> Iterator[None]:
    """Yield at once, and then whenever ``path`` was saved, went or came back, until Ctrl-C.

    Args:
        wake: set by a caller who wants an earlier look.
    """
    wake, seen = wake or threading.Event(), _signature(path)
    yield
    while True:
        woken = wake.wait(_GLANCE)
        wake.clear()
        now = _signature(path)
        if now != seen:
            seen = _settled(path, now)
        elif not woken:
            continue
        yield


def _settled(path: Path, now: Signature) -> Signature:
    """The file's state once a save is over: some programs write in several steps."""
    for _ in range(PATIENCE_MS // QUIET_MS):
        time.sleep(QUIET_MS / 1000)
        before, now = now, _signature(path)
        if now == before:
            break
    return now


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
    _made: Attempt | None = None
    _focus: str = ""
    _printed: str = ""

    def look(self, session: GradingSession) -> bool:
        """Grade the file if it was saved since the last look; True if it was."""
        noticed = time.perf_counter()
        path = self.here.workspace.path(self.exercise.place, self.name or self.exercise.module)
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
        if self._grade(session, noticed):
            return self.look(session)
        return True

    def press(self, key: str, session: GradingSession) -> bool:
        """Do what a key asks for; True if it does something."""
        if key == "h":
            give_hint(self.console, self.here, self.exercise, self._focus or None)
        elif key == "r":
            self._seen = None
            self.look(session)
        elif key in {"n", "v"} and self._made is not None:
            if key == "v":
                self.verbose = not self.verbose
            else:
                self._focus = _following(self._failing(), self._focus)
            self._show(self._made)
        else:
            return False
        self._flush_warnings()
        return True

    @property
    def keys(self) -> str:
        """The keys that do something now: a hint once one is due, another function if another one fails."""
        due = hint_is_due(self.here, self.exercise)
        hint = "h next hint, " if due else ""
        following = "n next failing function, " if len(self._failing()) > 1 else ""
        return f"{hint}{following}v details, r again, q leave"

    def reply(self) -> Watch:
        """The answer that ``--json`` prints at the end."""
        return Watch(
            exit_code=INTERRUPTED,
            exercise=self.exercise.id,
            runs=tuple(self.runs),
            last=self.last,
        )

    def _grade(self, session: GradingSession, noticed: float) -> bool:
        """Grade and show the file; True if that was dropped because of a newer save."""
        self._announce()
        try:
            work = chosen_work(self.here, self.exercise, self.name or self.exercise.module)
            with self._at_work(session) as superseded:
                made = attempts.attempt_in(session, work.submission, noticed)
                self._printed = made.printed
            if superseded.is_set():
                self.console.note("Saved again meanwhile: this run is dropped.")
                return True
            self.here.record("check", self.exercise.id, made.data(self.here.catalog.version))
            if made.problem is not None:
                raise made.problem
        except CourseError as error:
            if not isinstance(error, UngradableError):
                raise
            self._ungradable(error, noticed)
            return False
        verdict = made.verdict
        self._say_changes(verdict)
        self._made = made
        if self._focus not in self._failing():
            self._focus = ""
        self._show(made)
        step = next_step(self.here, made)
        if step != f"course watch {self.exercise.id}":
            self.console.next(step)
        self.last = reply_to(self.here.course, verdict, step, self._printed, curve_replies(made))
        self._remember(verdict.state, verdict.score, verdict.max_score, verdict.passed, noticed)
        self._flush_warnings()
        return False

    def _show(self, made: Attempt) -> None:
        show_loading(self.console, self._printed, whole=self.verbose)
        show_verdict(
            self.console, self.exercise, made.verdict, verbose=self.verbose, brief=True, focus=self._focus
        )
        # A picture takes the room that the finding needs, so it is one of the details.
        show_curve(self.console, made, focus=self._focus, drawn=self.verbose)

    def _failing(self) -> list[str]:
        """Functions that were begun and have a check that does not pass, in the order of the exercise."""
        every = self._made.verdict.checks if self._made is not None else ()
        found = []
        for task in self.exercise.task:
            checks = [check for check in every if check.task == task.id]
            if any(check.status != "pass" for check in checks) and not is_unwritten(checks):
                found.append(task.id)
        return found

    def _say_changes(self, verdict: Verdict) -> None:
        """First the checks that broke since the last run, and those that turned green."""
        if self._made is None:
            return
        before = {check.id: check.status for check in self._made.verdict.checks}
        broke = [c for c in verdict.checks if c.status != "pass" and before.get(c.id) == "pass"]
        fixed = [c for c in verdict.checks if c.status == "pass" and before.get(c.id, "pass") != "pass"]
        for label, style, changed in (("broke", "bold red", broke), ("fixed", "bold green", fixed)):
            for check in changed:
                self.console.item(label, check.title, style=style, width=_LABEL_WIDTH)
        if (broke or fixed) and self.console.fancy:
            self.console.blank()

    @contextlib.contextmanager
    def _at_work(self, session: GradingSession) -> Iterator[threading.Event]:
        """During a run: say what runs once it takes a while, and drop it when a newer save arrives."""
        superseded, done = threading.Event(), threading.Event()
        path = self.here.workspace.path(self.exercise.place, self.name or self.exercise.module)
        status = self.console.rich().status("", spinner="line") if self.console.motion else None
        begin = time.perf_counter()

        def look() -> None:
            while not done.wait(_GLANCE):
                signature = _signature(path)
                if signature is not None and signature[1] and signature != self._seen:
                    superseded.set()
                if superseded.is_set():
                    session.drop()
                elif status is not None and time.perf_counter() - begin > PATIENCE:
                    which = session.running or f"Checking {self.exercise.id}"
                    status.update(f"{time.perf_counter() - begin:.1f} s  {which}")
                    status.start()

        thread = threading.Thread(target=look, name="glance", daemon=True)
        thread.start()
        try:
            yield superseded
        finally:
            done.set()
            thread.join()
            if status is not None:
                status.stop()

    def _ungradable(self, error: UngradableError, noticed: float) -> None:
        show_loading(self.console, self._printed, whole=self.verbose)
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


def _following(names: list[str], now: str) -> str:
    """The name after ``now``, the first one after the last; "" if there is none."""
    if not names:
        return ""
    return names[(names.index(now) + 1) % len(names)] if now in names else names[min(1, len(names) - 1)]


def _signature(path: Path) -> Signature:
    """A file's stamp, which changes when it is saved; None if there is no file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return (status.st_mtime_ns, status.st_size, status.st_ino)

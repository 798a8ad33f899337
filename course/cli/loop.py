"""``course go`` and ``course watch``: one task after the other, a verdict after every save.

A task opens with its text, and its file is checked at every save. When it passes, the next one opens. The
grading session stays warm between saves, so a save costs only the checks themselves. The file is looked at
twenty times a second: one question to the file system, which works on every drive and system.
"""

from __future__ import annotations

import contextlib
import os
import re
import select
import shlex
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import msgspec

from course.catalog.models import Exercise
from course.cli.frame.app import again
from course.cli.frame.console import PATIENCE, Console, current
from course.cli.frame.here import Here
from course.cli.frame.options import Verbose, argument, exercise_ids
from course.cli.frame.replies import Envelope, ErrorBody, ErrorReply, NextStep, filled
from course.cli.home.advice import hint_is_due, is_done, next_in_course, next_step, next_task, why
from course.cli.home.replies import Go
from course.cli.reading.commands import show_text
from course.cli.work.changing import put, tell_length
from course.cli.work.checking import Check, CheckOrError, curve_replies, reply_to, show_curve
from course.cli.work.chosen import NOTEBOOK, asked_for, chosen_work, is_edited
from course.cli.work.hinting import give_hint
from course.cli.work.verdict import is_unwritten, show_changes, show_loading, show_verdict
from course.errors import INTERRUPTED, CourseError, UngradableError
from course.handed_in import attempts
from course.handed_in.attempts import Attempt
from course.scoring.verdict import Verdict

if TYPE_CHECKING:
    from course.scoring.judging.session import GradingSession


class WatchRun(msgspec.Struct, frozen=True):
    """One verdict of a watch. ``at`` is UTC; ``latency_ms`` runs from noticing the save to the verdict.

    ``exercise`` is the one that was checked: without a name, a watch goes from one to the next.
    """

    at: str
    state: str
    score: float
    max_score: float
    passed: bool
    latency_ms: float
    exercise: str = ""


class Watch(Envelope, tag="course.watch/1", frozen=True, kw_only=True):
    """Printed when the watch ends. ``exercise`` is the one that was watched last."""

    refers_to = (Check,)

    exercise: str
    runs: tuple[WatchRun, ...]
    last: CheckOrError | None = None


# ---
# Single key presses while a command waits or works, on a terminal only.


_LEAVE = "q"


class Keys:
    """Keys of a terminal as they are pressed, without Enter. What is typed after q stays for the shell."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._held = ""

    def wait(self, seconds: float) -> str:
        """The next key; "" if none is pressed for so long."""
        if not self._held:
            self._take(seconds)
        key, self._held = self._held[:1], self._held[1:]
        return key

    @property
    def leave(self) -> bool:
        """Whether q was pressed; the keys before it are kept."""
        if _LEAVE not in self._held:
            self._take(0)
        return _LEAVE in self._held

    def _take(self, seconds: float) -> None:
        ready, _, _ = select.select([self._descriptor], [], [], seconds)
        if ready:
            pressed = os.read(self._descriptor, 1)
            self._held += pressed.decode("ascii", "ignore") if pressed else _LEAVE  # a terminal that is gone


@contextlib.contextmanager
def _keys(console: Console) -> Iterator[Keys | None]:
    """Keys, if a user is there to press them and the system has such terminals.

    Ctrl-C keeps its meaning. The terminal is restored afterwards, with what was typed and not taken.
    """
    try:
        import termios
        import tty
    except ImportError:  # Windows
        termios = None  # type: ignore[assignment]
    if termios is None or not console.interactive or console.quiet:
        yield None
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)
    try:
        tty.setcbreak(descriptor, termios.TCSADRAIN)
        yield Keys(descriptor)
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


#: A save counts as done once the file has not changed for this long, in ms.
QUIET_MS = 20
#: A save that never ends is checked after this long anyway, in ms.
PATIENCE_MS = 200
#: Some programs empty a file and then write it, so an empty file is looked at again after this, in s.
SECOND_LOOK = 0.05
#: How often a newer save is looked for, in s.
_GLANCE = 0.05
#: A link, as a README writes it.
_LINK = re.compile(r"\[([^]]*)\]\([^)]*\)")

#: Of each file that is there: its stamp, which changes when it is saved.
Signature = tuple[tuple[int, int, int], ...]


def watch(
    exercise: Annotated[
        str | None,
        argument("EXERCISE", "Its id, its number, or its file; task after task if left out.", exercise_ids),
    ] = None,
    verbose: Verbose = False,
) -> int:
    """Check again on every save.

    With a name: that exercise alone. Without one it is `course go`, and begins with the task of the folder.
    On a terminal, keys give the next hint, the lesson, the next failing function, details or another run; q
    or Ctrl-C ends it. With --json the one object is printed at the end.
    """
    console, here = current(), Here.load()
    if exercise is None:
        return _Loop(console, here, verbose).run(here.of_folder())
    # A missing file is an error at the start; later it is something to wait for.
    chosen, named = asked_for(here, exercise)
    work = chosen_work(here, chosen, named)
    for note in work.notes:
        console.warn(note)
    return _Loop(console, here, verbose, alone=True, named=named).run(chosen)


def go() -> int:
    """Do one task after the other, checked at every save.

    The next warm-up or exercise opens with its text. When it passes, the next one opens; after the last come
    the quiz and `course submit`. Keys give a hint, the lesson where it explains the task, the task before and
    the one after. With --json it opens nothing and says what is next.
    """
    console, here = current(), Here.load()
    if console.json:
        step = next_in_course(here.catalog, here.standing())
        return console.answer(Go(next=NextStep(step), why=why(here.catalog, step)))
    return _Loop(console, here).run()


@dataclass
class _Loop:
    """Tasks, one after the other, until the user leaves.

    Attributes:
        alone: stay with the first one.
        named: its file, if that was named.
    """

    console: Console
    here: Here
    verbose: bool = False
    alone: bool = False
    named: str | None = None
    runs: list[WatchRun] = field(default_factory=list)
    last: Check | ErrorReply | None = None

    def run(self, task: Exercise | None = None) -> int:
        """Work on a task, or on the next one, and on those that follow; the exit code."""
        from course.isolation.probe import kept_sandboxes

        task, code, name = task or next_task(self.here.catalog, self.here.standing()), 0, ""
        self.console.led = True
        try:
            if task is None:
                self._after_all()
            with kept_sandboxes():  # the tasks are checked one after the other
                while task is not None:
                    name = task.id
                    task = self._work(task)
        except KeyboardInterrupt:
            code = INTERRUPTED
            self.console.gap()  # the terminal has written ^C
        finally:
            self.console.led = False
        reply = Watch(exit_code=code, exercise=name, runs=tuple(self.runs), last=self.last)
        return self.console.answer(reply)

    def _work(self, task: Exercise) -> Exercise | None:
        """Work on a task until it passes or the user wants another one, which is returned."""
        self.here, console = Here.load(), self.console
        watcher = Watcher(console, self.here, task, self.verbose, self.named, self.runs)
        stays = self.alone
        if not self.alone:
            self._open(task)
        begun = watcher.is_begun()
        if not self.alone and begun:  # back to one that is done: not on at once
            stays = is_done(self.here.standing(), task)
        elif not self.alone:  # look at nothing before the next save
            watcher.seen = _signature(watcher.paths)
        session: GradingSession | None = None
        try:
            with contextlib.ExitStack() as kept:
                while True:
                    with _keys(console) as keys:
                        watcher.pressed = keys
                        self._remind(watcher, keys)
                        # Once there is something to read: what a session needs takes a second to load.
                        if session is None:
                            session = kept.enter_context(attempts.open_session(task, self.here.catalog))
                        key = self._until_key(watcher, session, keys, stays=stays)
                    if key not in {"l", "t"}:
                        return self._other(task, key)
                    self._show(task, watcher, key)
        finally:
            self.verbose, self.last = watcher.verbose, watcher.last or self.last

    def _until_key(self, watcher: Watcher, session: GradingSession, keys: Keys | None, *, stays: bool) -> str:
        """Check every save until a key leads elsewhere, which is returned; "" once the task passes.

        Args:
            stays: a pass at the first look does not lead on.
        """
        for key in saves(watcher.paths, keys):
            if key in self._elsewhere(watcher.exercise) and key:
                return key
            told = watcher.press(key, session) if key else watcher.look(session)
            if told and key in {"", "r"} and watcher.passes and not stays:
                return ""
            if told:
                self._remind(watcher, keys)
            stays = self.alone
        return _LEAVE

    def _remind(self, watcher: Watcher, keys: Keys | None) -> None:
        """The watched file and the keys: what was said at the start is off the screen by now."""
        if keys is not None:
            others = {"l": "l lesson", "t": "t text", "b": "b back", "s": "s skip", _LEAVE: f"{_LEAVE} leave"}
            words = [words for key, words in others.items() if key in self._elsewhere(watcher.exercise)]
            self.console.note((f"Waiting for a save of {watcher.shown}.", "dim"))
            self.console.note((f"Keys: {', '.join([*watcher.keys, *words])}", "dim"))
        elif watcher.last is None:
            self.console.note(f"Watching {watcher.shown}; Ctrl-C ends it.")
        self.console.flush()

    def _elsewhere(self, task: Exercise) -> str:
        """The keys that lead away from the verdicts on a task."""
        return "lt" + ("" if self.alone else "s" if self._before(task) is None else "bs") + _LEAVE

    def _before(self, task: Exercise) -> Exercise | None:
        every = self.here.catalog.every_task()
        return every[every.index(task) - 1] if task != every[0] else None

    def _other(self, task: Exercise, key: str) -> Exercise | None:
        """The task to go on with after a pass, or after a key."""
        if key == _LEAVE:
            return None
        if key == "b":
            return self._before(task)
        if key != "s" and (Path(task.folder) / "report.py").is_file():
            self.console.note(f"What your code shows: course report {task.id}")
        following = next_task(self.here.catalog, self.here.standing(), task)
        if following is None:
            self._after_all()
        return following

    def _after_all(self) -> None:
        """No task is left: the quiz, and handing in, each if the user agrees."""
        before, step = "", next_in_course(self.here.catalog, self.here.standing())
        while step != before:
            self.console.note((f"Next: {step}", "bold"), (f"  {why(self.here.catalog, step)}", "dim"))
            if not self.console.interactive or not self.console.go_on(""):
                return
            again(shlex.split(step)[1:])
            before, step = step, next_in_course(self.here.catalog, self.here.standing())

    def _open(self, task: Exercise) -> None:
        """The text of a task, and its file in the workspace."""
        console, catalog = self.console, self.here.catalog
        every = catalog.warm_ups() if task.is_warm_up else catalog.exercises()
        called = f"{'Warm-up' if task.is_warm_up else 'Exercise'} {catalog.place_of(task)} of {len(every)}"
        console.blank()
        if console.fancy:
            console.rich().rule(f"{called}: {task.id}")
        else:
            console.note(f"{called}: {task.id}")
        self._text(task)
        put(console, self.here, task)

    def _text(self, task: Exercise) -> None:
        console = self.console
        if console.quiet:
            return
        if task.is_warm_up:
            show_text(console, self.here, task)
        else:
            console.heading(task.title)
            text = task.readme_path.read_text(encoding="utf-8").partition("\n## ")[0]
            for paragraph in text.split("\n\n")[1:]:
                console.line(_LINK.sub(r"\1", " ".join(paragraph.split())))
            for each in task.task:
                console.item(each.id, each.title, width=max(len(one.id) for one in task.task))
            tell_length(console, self.here, task)
        console.note(f"Explained in: course lesson {task.where_to_read('')}")

    def _show(self, task: Exercise, watcher: Watcher, key: str) -> None:
        """The task's text once more, or the lesson where it explains it."""
        try:
            if key == "l":
                by_line = ["--page"] if self.console.plain else []
                again(["lesson", task.where_to_read(watcher.about), *by_line])
            elif task.is_warm_up:
                self._text(task)
            else:
                with self.console.paged():
                    self.console.block(task.readme_path.read_text(encoding="utf-8"))
        except CourseError as error:
            self.console.error(error.message, error.help)
        self.here = watcher.here = Here.load()


def saves(paths: Sequence[Path], keys: Keys | None = None) -> Iterator[str]:
    """Yield "" at once and whenever a file was saved, went or came back, and each key, until Ctrl-C."""
    seen = _signature(paths)
    yield ""
    while True:
        key = keys.wait(_GLANCE) if keys is not None else ""
        if keys is None:
            time.sleep(_GLANCE)
        now = _signature(paths)
        if now != seen:
            seen = _settled(paths, now)
            yield ""
        if key:
            yield key


def _settled(paths: Sequence[Path], now: Signature) -> Signature:
    """The files' state once a save is over: some programs write in several steps."""
    for _ in range(PATIENCE_MS // QUIET_MS):
        time.sleep(QUIET_MS / 1000)
        before, now = now, _signature(paths)
        if now == before:
            break
    return now


@dataclass
class Watcher:
    """Turns saves into verdicts and remembers them.

    Attributes:
        named: the file that is watched; None for the one that counts, the module or its notebook.
        pressed: keys, which q is looked for in while checks run.
    """

    console: Console
    here: Here
    exercise: Exercise
    verbose: bool = False
    named: str | None = None
    runs: list[WatchRun] = field(default_factory=list)
    last: Check | ErrorReply | None = None
    pressed: Keys | None = None
    _name: str = ""
    seen: Signature | None = None
    _gone: bool = False
    _left: bool = False
    _made: Attempt | None = None
    _focus: str = ""
    _printed: str = ""

    def look(self, session: GradingSession) -> bool:
        """Grade the file if it was saved since the last look; True if it was."""
        noticed = time.perf_counter()
        signature = _signature(self.paths)
        if not signature:
            if not self._gone:
                self.console.line(f"{self.shown} is gone; waiting for it to come back.")
            self._gone, self.seen = True, None
            return False
        if signature == self.seen:
            return False
        if _has_empty(signature):
            time.sleep(SECOND_LOOK)
            signature = _signature(self.paths)
        self.seen, self._gone = signature, False
        return self.look(session) if self._grade(session, noticed) else True

    def press(self, key: str, session: GradingSession) -> bool:
        """Do what a key asks for; True if it does something."""
        if key == "h":
            give_hint(self.console, self.here, self.exercise, self._focus or None)
        elif key == "r":
            self.seen = None
            self.look(session)
        elif key in {"n", "v"} and self._made is not None:
            if key == "v":
                self.verbose = not self.verbose
            else:
                failing = self._failing()
                # The one after it; the second where none was asked for, since the first is shown.
                following = failing.index(self._focus) + 1 if self._focus in failing else 1
                self._focus = failing[following % len(failing)] if failing else ""
            self._show(self._made)
        else:
            return False
        self._flush_warnings()
        return True

    @property
    def keys(self) -> list[str]:
        """The keys that do something now: a hint once one is due, another function if another one fails."""
        keys = ["h hint"] if hint_is_due(self.here, self.exercise) else []
        keys += ["n next failing"] if len(self._failing()) > 1 else []
        return [*keys, "v more" if self._made is not None else "r check"]

    @property
    def paths(self) -> tuple[Path, ...]:
        module = self.exercise.module
        names = (self.named,) if self.named else (module, Path(module).with_suffix(NOTEBOOK).name)
        return tuple(self.here.workspace.path(self.exercise.place, name) for name in names)

    @property
    def shown(self) -> str:
        """The file that counts, for a person to read."""
        name = self.named or self._name or self.exercise.module
        return self.here.workspace.shown(self.here.workspace.path(self.exercise.place, name))

    @property
    def passes(self) -> bool:
        """Whether every check passed at the last look."""
        return self.last is not None and self.last.ok

    @property
    def about(self) -> str:
        """The function to read about: the one that is shown, or the first that fails."""
        return self._focus or next(iter(self._failing()), "")

    def is_begun(self) -> bool:
        """Whether there is something to check: the file that counts was edited."""
        try:
            work = chosen_work(self.here, self.exercise, self.named)
            self._name = work.name
            return work.notebook is not None or is_edited(work)
        except CourseError:  # the check says what is wrong
            return True

    def _grade(self, session: GradingSession, noticed: float) -> bool:
        """Grade and show the file; True if that was dropped because of a newer save."""
        moment = datetime.now().astimezone().strftime("%H:%M:%S")
        if self.console.fancy:
            self.console.rich().rule(f"{moment}  {self.exercise.id}", style="dim")
        else:
            self.console.note(f"Checked at {moment}: {self.exercise.id}")
        try:
            work = chosen_work(self.here, self.exercise, self.named)
            self._name = work.name
            with self._at_work(session) as superseded:
                made = attempts.attempt_in(session, work.submission, noticed)
                self._printed = made.printed
            if self._left:
                return False
            if superseded.is_set():
                self.console.note("Saved again meanwhile: this run is dropped.")
                return True
            self.here.record("check", self.exercise.id, made.data(self.here.catalog.version))
            if made.problem is not None:
                raise made.problem
        except UngradableError as error:
            self._remember("ungradable", 0.0, 0.0, False, noticed)
            show_loading(self.console, self._printed, whole=self.verbose)
            self.console.line(error.message)
            if error.help:
                self.console.line(error.help)
            body = filled(ErrorBody, error)
            self.last = ErrorReply(schema="course.check/1", exit_code=error.exit_code, error=body)
            self._flush_warnings()
            return False
        verdict = made.verdict
        self._remember(verdict.state, verdict.score, verdict.max_score, verdict.passed, noticed)
        self._say_changes(verdict)
        self._made = made
        if self._focus not in self._failing():
            self._focus = ""
        self._show(made)
        step = next_step(self.here, made)
        if step != f"course watch {self.exercise.id}":
            self.console.next(step)
        self.last = reply_to(self.here.course, verdict, step, self._printed, curve_replies(made))
        self._flush_warnings()
        return False

    def _show(self, made: Attempt) -> None:
        show_loading(self.console, self._printed, whole=self.verbose)
        show_verdict(
            self.console,
            self.exercise,
            made.verdict,
            verbose=self.verbose,
            brief=True,
            focus=self._focus,
            keyed=self.pressed is not None,
        )
        # A picture takes the room that the finding needs, so it is one of the details.
        show_curve(self.console, made, focus=self._focus, drawn=self.verbose)

    def _failing(self) -> list[str]:
        """Functions that were begun and have a check that does not pass, in the order of the exercise."""
        every = self._made.verdict.checks if self._made is not None else ()
        checks = {task.id: [check for check in every if check.task == task.id] for task in self.exercise.task}
        wrong = {check.task for check in every if check.status != "pass"}
        return [task for task, own in checks.items() if task in wrong and not is_unwritten(own)]

    def _say_changes(self, verdict: Verdict) -> None:
        """First the checks that broke since the last run, and those that were wrong and turned green."""
        if self._made is None:
            return
        checks = self._made.verdict.checks
        before = {check.id: check.status for check in checks if not is_unwritten([check])}
        passing = [check for check in verdict.checks if check.status == "pass"]
        broke = [c.title for c in verdict.checks if c not in passing and before.get(c.id) == "pass"]
        fixed = [check.title for check in passing if before.get(check.id, "pass") != "pass"]
        show_changes(self.console, broke, fixed)

    @contextlib.contextmanager
    def _at_work(self, session: GradingSession) -> Iterator[threading.Event]:
        """During a run: say what runs once it takes a while, and drop it when a newer save arrives."""
        superseded, done = threading.Event(), threading.Event()
        status = self.console.rich().status("", spinner="line") if self.console.motion else None
        begin = time.perf_counter()

        def look() -> None:
            while not done.wait(_GLANCE):
                signature = _signature(self.paths)
                if signature and not _has_empty(signature) and signature != self.seen:
                    superseded.set()
                self._left = self._left or (self.pressed is not None and self.pressed.leave)
                if superseded.is_set() or self._left:
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

    def _remember(self, state: str, score: float, maximum: float, passed: bool, noticed: float) -> None:
        at = datetime.now(UTC).isoformat(timespec="milliseconds")
        latency = round(1000 * (time.perf_counter() - noticed), 1)
        self.runs.append(WatchRun(at, state, score, maximum, passed, latency, self.exercise.id))

    def _flush_warnings(self) -> None:
        for warning in dict.fromkeys(self.here.warnings):
            self.console.warn(warning)
        self.here.warnings.clear()
        self.console.flush()


def _has_empty(signature: Signature) -> bool:
    return any(size == 0 for _, size, _ in signature)


def _signature(paths: Sequence[Path]) -> Signature:
    found = []
    for path in paths:
        with contextlib.suppress(OSError):
            status = path.stat()
            found.append((status.st_mtime_ns, status.st_size, status.st_ino))
    return tuple(found)

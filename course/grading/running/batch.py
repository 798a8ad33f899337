"""Grades a class: N grader processes, one coordinator, results as they come.

A grader that dies takes one submission with it at most: that one is tried again, and after the third grader
it kills it is reported as our fault. A grader that hangs is ended at a deadline beyond those of a submission.
"""

from __future__ import annotations

import contextlib
import os
import selectors
import subprocess
import sys
import time
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Self

import msgspec

from course.catalog.locate import ENVIRONMENT_VARIABLE
from course.errors import CourseError, InternalError
from course.grading.intake.students import Entry
from course.grading.pipes import read_frame, write_frame
from course.grading.running.grader import Answer, Config, Job
from course.grading.running.snapshot import in_use
from course.isolation.deadline import WALL
from course.isolation.launch import keep_private, sweep_after_the_dead
from course.scoring.judging.session import Terms
from course.scoring.remote import BUDGET_S
from course.scoring.verdict import Problem, Verdict, not_graded

#: After so many deaths of graders a submission is not tried again and counts as our fault; or no grader
#: starts.
MAX_TRIES = 3
_TICK_S = 0.5


@dataclass(frozen=True)
class Graded:
    """One entry and the verdict on it.

    Attributes:
        version: of the graders that judged it, by their own account; empty where none did.
        asked: by check, the functions that it used, where the entry asks for that.
    """

    entry: Entry
    verdict: Verdict
    version: str = ""
    asked: Mapping[str, Sequence[str]] = field(default_factory=dict)


@dataclass
class _Work:
    entry: Entry
    job: Job
    tries: int = 0


@dataclass
class _Grader:
    """A grader process and the work it has in hand."""

    number: int
    process: subprocess.Popen[bytes]
    work: _Work | None = None
    ready: bool = False
    since: float = field(default_factory=time.monotonic)


def grade_all(entries: Iterable[Entry], terms: Terms, *, graders: int = 1) -> Iterator[Graded]:
    """Verdicts on all entries that have a submission or a problem, in the order of arrival.

    Args:
        terms: which snapshot judges, and how; it must be unpacked here.
        graders: processes.

    Raises:
        CourseError: no grader can work here at all (protection level, content).
    """
    with Graders(terms, graders) as those:
        yield from those.grade(entries)


def start_grader(config: Config) -> subprocess.Popen[bytes]:
    """A grader process, told how to grade. Its first answer says that it has started."""
    keep_private()  # all messages to and from graders pass through here
    # -P: the folder the command is run in, which may be a student's, never becomes importable.
    command = [sys.executable, "-P", "-m", "course.grading.running.grader"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    graders = in_use(config.terms.graders)
    if graders is None:
        raise InternalError("The snapshot that is to judge is not unpacked here.")
    path = str(graders.folder), environment.get("PYTHONPATH")
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, path))
    environment[ENVIRONMENT_VARIABLE] = str(graders.catalog.content.root)
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment, start_new_session=True
    )
    assert process.stdin is not None
    with contextlib.suppress(BrokenPipeError):
        write_frame(process.stdin, config)
    return process


def hang_s(timeout: float) -> float:
    """Wall seconds after which a grader hangs: longer than a submission may take by its own deadlines."""
    return WALL * (BUDGET_S + timeout) + 30.0


class Graders:
    """Grader processes of this machine; they stay warm from one class to the next.

    Args:
        terms: as for ``grade_all``.
        graders: processes, at most; each is started when there is work for it.
    """

    def __init__(self, terms: Terms, graders: int) -> None:
        self._entries: Iterator[Entry] = iter(())
        self._terms = terms
        self._frozen = in_use(terms.graders)
        self._places = graders
        self._again: deque[_Work] = deque()
        self._done: deque[Graded] = deque()
        self._graders: dict[int, _Grader] = {}
        self._selector = selectors.DefaultSelector()
        self._hang_s = hang_s(terms.timeout)  # only a fault of ours gets here
        self._false_starts = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def grade(self, entries: Iterable[Entry]) -> Iterator[Graded]:
        """As ``grade_all``; a class must be finished before the next is begun."""
        self._entries = iter(entries)
        for number in range(self._places):
            if not self._feed(number):
                break
        while True:
            while self._done:
                yield self._done.popleft()
            if not any(grader.work for grader in self._graders.values()):
                if not self._again:
                    return
                self._feed(next(iter(self._graders), 0))
                continue
            for key, _ in self._selector.select(_TICK_S):
                self._collect(self._graders[key.data])
            self._end_hung()

    def close(self) -> None:
        """End the processes."""
        for grader in self._graders.values():
            with contextlib.suppress(OSError):
                if grader.process.stdin:
                    grader.process.stdin.close()  # it ends at end of file, its sandbox with it
        for grader in self._graders.values():
            try:
                grader.process.wait(0 if grader.work else 5)
            except subprocess.TimeoutExpired:
                grader.process.kill()
                grader.process.wait()
            if grader.process.stdout:
                grader.process.stdout.close()
        self._selector.close()
        sweep_after_the_dead()  # nobody comes after the last grader, should that one have been killed

    # -- work -----------------------------------------------------------------------------------------

    def _next(self) -> _Work | None:
        """The next submission; entries that need no grader are finished on the way."""
        if self._again:
            return self._again.popleft()
        for entry in self._entries:
            if entry.submission is not None:
                exercise = entry.exercise.id
                version = self._frozen.version(exercise) if self._frozen else ""
                files = dict(entry.submission.files)
                return _Work(entry, Job(exercise, files, version, only=entry.only, asks=entry.asks))
            if entry.problem is not None:
                self._done.append(Graded(entry, without_grading(entry, "ungradable", entry.problem)))
        return None

    def _feed(self, number: int) -> bool:
        """Give a grader its next submission, starting it if need be; False when there is none left."""
        work = self._next()
        if work is None:
            return False
        grader = self._graders.get(number) or self._start(number)
        grader.work = work
        grader.since = time.monotonic()
        assert grader.process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # it died: reading from it will say so
            write_frame(grader.process.stdin, work.job)
        return True

    def _start(self, number: int) -> _Grader:
        process = start_grader(Config(self._terms, number))
        assert process.stdout is not None
        grader = _Grader(number, process)
        self._graders[number] = grader
        self._selector.register(process.stdout, selectors.EVENT_READ, number)
        return grader

    def _collect(self, grader: _Grader) -> None:
        """Take a grader's answer, or note its death, and give it or its successor more to do."""
        assert grader.process.stdout is not None
        frame = read_frame(grader.process.stdout)
        if not grader.ready and frame is not None:
            grader.ready, self._false_starts = True, 0
            return
        work, grader.work = grader.work, None
        if not grader.ready:
            self._start_again(grader, work)
            return
        answer = answer_to(work.job, frame) if work is not None else None
        if answer is None or work is None:
            self._bury(grader)
            if work is not None:
                self._retry(work)
        elif answer.error is not None:
            raise as_error(answer.error, answer.exit_code)
        else:
            assert answer.verdict is not None
            self._done.append(Graded(work.entry, answer.verdict, answer.version, answer.asked))
        self._feed(grader.number)

    def _start_again(self, grader: _Grader, work: _Work | None) -> None:
        """Replace a grader that died before any submission came near it.

        Raises:
            InternalError: none can start.
        """
        self._false_starts += 1
        if self._false_starts >= MAX_TRIES:
            raise InternalError("A grader process cannot start; what it printed is above.")
        self._bury(grader)
        if work is not None:
            self._again.append(work)
        self._feed(grader.number)

    def _retry(self, work: _Work) -> None:
        work.tries += 1
        if work.tries < MAX_TRIES:
            self._again.append(work)
            return
        self._done.append(
            Graded(work.entry, without_grading(work.entry, "grader_error", killed_its_grader()))
        )

    def _bury(self, grader: _Grader) -> None:
        assert grader.process.stdout is not None
        self._selector.unregister(grader.process.stdout)
        grader.process.kill()
        grader.process.wait()
        grader.process.stdout.close()
        if grader.process.stdin:
            with contextlib.suppress(OSError):
                grader.process.stdin.close()
        del self._graders[grader.number]

    def _end_hung(self) -> None:
        now = time.monotonic()
        for grader in list(self._graders.values()):
            if grader.work and (now - grader.since > self._hang_s or _is_stopped(grader.process.pid)):
                grader.process.kill()  # its pipe closes, and the next round finds it dead


def _is_stopped(pid: int) -> bool:
    """Whether a signal stopped that process: a submission at L1 may send one, and nothing would wake it."""
    if not hasattr(os, "waitid"):
        return False
    with contextlib.suppress(ChildProcessError):
        return os.waitid(os.P_PID, pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT) is not None
    return False


def answer_to(job: Job, frame: bytes | None) -> Answer | None:
    """The answer in a grader's frame; None if there is none, or one to something else than was asked.

    A grader that answers another question than it was asked counts as dead, because something else may have
    answered.
    """
    if frame is None:
        return None
    try:
        answer = msgspec.msgpack.decode(frame, type=Answer)
    except msgspec.MsgspecError:
        return None
    return answer if answer.is_about(job) else None


def as_error(problem: Problem, exit_code: int) -> CourseError:
    """A grader's error, raised again here."""
    error = CourseError(problem.message, help=problem.help, code=problem.code)
    error.exit_code = exit_code
    return error


def killed_its_grader() -> Problem:
    """The verdict on a submission that no grader survived."""
    return Problem(
        "grader_died",
        f"The grader died {MAX_TRIES} times on this submission.",
        "Report this; the submission is marked for regrading.",
    )


def without_grading(entry: Entry, state: str, problem: Problem) -> Verdict:
    """The verdict on an entry that no grader has to judge."""
    return not_graded(entry.exercise.id, entry.exercise.max_points, state, problem)

"""Grades a class: N grader processes, one coordinator, results as they come.

A grader that dies takes one submission with it at most: that one is tried again, and after the third grader
it kills it is reported as our fault. A grader that hangs is ended at a deadline beyond those of a submission.
"""

import contextlib
import os
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from typing import Self

import msgspec

from course.catalog.locate import ENVIRONMENT_VARIABLE
from course.catalog.models import LONGEST
from course.errors import CourseError, InternalError
from course.grading.intake.students import Entry
from course.grading.pipes import Servant, launched, path_with, write_frame
from course.grading.running.grader import Answer, Config, Job
from course.grading.running.snapshot import in_use
from course.isolation.launch import ONE_THREAD, keep_private, sweep_after_the_dead
from course.isolation.levels import BUDGET_S, SEARCH_S, WALL
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Problem, Verdict, not_graded

#: After so many deaths of graders a submission is not tried again and counts as our fault; or no grader
#: starts.
MAX_TRIES = 3
#: On a submission that no grader survived.
KILLED_ITS_GRADER = Problem(
    "grader_died",
    f"The grader died {MAX_TRIES} times on this submission.",
    "Report this; the submission is marked for regrading.",
)
_GRADER = "course.grading.running.grader"


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


def grade_all(entries: Iterable[Entry], terms: Terms, *, graders: int = 1) -> Iterator[Graded]:
    """Verdicts on all entries that have a submission or a problem, in the order of arrival.

    Args:
        terms: which snapshot judges, and how; it must be unpacked here.

    Raises:
        CourseError: no grader can work here at all (protection level, content).
    """
    with Graders(terms, graders) as those:
        yield from those.grade(entries)


def start_grader(config: Config) -> subprocess.Popen[bytes]:
    """A grader process, told how to grade. Its first answer says that it has started."""
    keep_private()  # all messages to and from graders pass through here
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    graders = in_use(config.terms.graders)
    if graders is None:
        raise InternalError("The snapshot that is to judge is not unpacked here.")
    environment |= ONE_THREAD | {"PYTHONPATH": path_with(graders.folder)}
    environment[ENVIRONMENT_VARIABLE] = str(graders.catalog.content.root)
    process = launched(_GRADER, environment=environment)
    assert process.stdin is not None
    with contextlib.suppress(BrokenPipeError):
        write_frame(process.stdin, config)
    return process


class WarmGrader(Servant):
    """A grader process, started when there is something to grade and replaced when it dies.

    It is killed once it takes longer than a submission may by its own deadlines.
    """

    tries = MAX_TRIES
    cannot_start = "A grader process cannot start; what it printed is above."

    def __init__(self, config: Config) -> None:
        longest = WALL * LONGEST * (BUDGET_S + SEARCH_S + config.terms.timeout) + 30.0
        super().__init__(_GRADER, wall_s=longest)
        self.config = config

    def answer(self, job: Job) -> Answer:
        """The grader's answer; an empty one if this submission killed every grader it was given to.

        Raises:
            InternalError: no grader can be started here.
        """
        for _ in range(MAX_TRIES):
            with contextlib.suppress(msgspec.MsgspecError):  # no frame is none of an answer either
                answer = msgspec.msgpack.decode(self.ask(job) or b"", type=Answer)
                if answer.is_about(job):
                    return answer
            self.close()  # also one that answers another question: something else may have answered
        return Answer(number=job.number, sha256=Submission(job.files).sha256)

    def _launch(self) -> subprocess.Popen[bytes]:
        return start_grader(self.config)


class Graders:
    """Grader processes of this machine; they stay warm from one class to the next.

    Args:
        terms: as for ``grade_all``.
        graders: processes, at most; each is started when there is work for it.
    """

    def __init__(self, terms: Terms, graders: int) -> None:
        self._frozen = in_use(terms.graders)
        self._places = graders
        self._graders = [WarmGrader(Config(terms, number)) for number in range(graders)]
        self._idle = self._graders[::-1]
        self._threads = ThreadPoolExecutor(graders)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def grade(self, entries: Iterable[Entry]) -> Iterator[Graded]:
        """As ``grade_all``; a class must be finished before the next is begun."""
        entries = iter(entries)
        at_work: dict[Future[Answer], Entry] = {}
        arrived: list[tuple[Entry, Answer]] = []
        while True:
            while len(at_work) < self._places and (entry := next(entries, None)) is not None:
                if entry.submission is not None:
                    version = self._frozen.version(entry.exercise.id) if self._frozen else ""
                    at_work[self._threads.submit(self._answer, job_of(entry, version))] = entry
                elif entry.problem is not None:
                    yield Graded(entry, without_grading(entry, "ungradable", entry.problem))
            for entry, answer in arrived:
                if answer.error is not None:
                    raise as_error(answer.error, answer.exit_code)
                verdict = answer.verdict or without_grading(entry, "grader_error", KILLED_ITS_GRADER)
                yield Graded(entry, verdict, answer.version, answer.asked)
            if not at_work:
                return
            done, _ = wait(at_work, return_when=FIRST_COMPLETED)
            arrived = [(at_work.pop(future), future.result()) for future in done]

    def _answer(self, job: Job) -> Answer:
        grader = self._idle.pop()
        try:
            return grader.answer(job)
        finally:
            self._idle.append(grader)

    def close(self) -> None:
        for grader in self._graders:
            if grader in self._idle:
                self._threads.submit(grader.close, 5.0)
            else:
                grader.end()
        self._threads.shutdown()
        for grader in self._graders:
            grader.close()
        sweep_after_the_dead()  # nobody comes after the last grader, should that one have been killed


def job_of(entry: Entry, version: str) -> Job:
    """What a grader of that version is asked about an entry that has a submission."""
    assert entry.submission is not None
    files = dict(entry.submission.files)
    return Job(entry.exercise.id, files, version, only=entry.only, asks=entry.asks)


def as_error(problem: Problem, exit_code: int) -> CourseError:
    """A grader's error, raised again here."""
    error = CourseError(problem.message, help=problem.help, code=problem.code)
    error.exit_code = exit_code
    return error


def without_grading(entry: Entry, state: str, problem: Problem) -> Verdict:
    """The verdict on an entry that no grader has to judge."""
    return not_graded(entry.exercise.id, entry.exercise.max_points, state, problem)

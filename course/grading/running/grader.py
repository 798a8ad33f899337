"""One grader process: reads jobs from standard input, writes verdicts to standard output.

It is trusted, and only ever talks to the coordinator that started it. Frames are a 4-byte little-endian
length and msgpack. Each exercise's checks are collected at its first job and kept for the next. An exercise
whose checks cannot be collected has no verdicts but "grader_error"; the others are graded.
"""

from __future__ import annotations

import atexit
import gc
import math
import os
import secrets
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from course.errors import ContentError, CourseError, MissingCapabilityError
from course.grading.pipes import read_frame, served, write_frame
from course.handed_in.notebook import opened
from course.isolation.launch import keep_private
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Problem, Verdict, format_points, in_points, not_graded

if TYPE_CHECKING:
    from course.catalog.models import Exercise
    from course.scoring.judging.session import GradingSession

#: As in ``course.cli.frame.app``: what a grader loads is no garbage, while it starts and when it ends.
_GARBAGE = 50_000
#: Sessions, each with a sandbox of some 30 MB; more than a class has exercises. An audit has forty.
_MOST_OPEN = 10


class Config(msgspec.Struct, frozen=True):
    """A grader's settings.

    Attributes:
        processor: number that picks the processor to stay on.
    """

    terms: Terms
    processor: int


class Job(msgspec.Struct, frozen=True):
    """One submission to grade.

    Attributes:
        version: the ``grader_version`` that must grade it; empty takes the one here.
        only: checks to run, with those they require; empty runs all.
        asks: which functions each check used is to be told, too.
        number: drawn at random for each job, so that only the grader knows it.
    """

    exercise: str
    files: dict[str, bytes]
    version: str = ""
    only: tuple[str, ...] = ()
    asks: bool = False
    number: int = msgspec.field(default_factory=lambda: secrets.randbits(63))


class Answer(msgspec.Struct, frozen=True):
    """The verdict on a job, or why this grader can give none.

    Attributes:
        number: of the job it answers.
        sha256: digest of the graded content, computed by the grader itself.
        version: of the graders that judged, computed by the grader itself.
        asked: by check, the functions of the submission that it used, if the job asks for that.
    """

    verdict: Verdict | None = None
    error: Problem | None = None
    exit_code: int = 0
    number: int = 0
    sha256: str = ""
    version: str = ""
    asked: dict[str, tuple[str, ...]] = {}

    def is_about(self, job: Job) -> bool:
        """Whether it answers this job and no other, and comes from the right graders."""
        same = self.number == job.number and self.sha256 == Submission(job.files).sha256
        return same and (self.verdict is None or job.version in {"", self.version})


def main() -> None:
    """Serve until standard input ends."""
    gc.set_threshold(_GARBAGE, 20, 20)
    atexit.register(gc.freeze)
    keep_private()
    source = os.fdopen(os.dup(0), "rb")
    sink = os.fdopen(os.dup(1), "wb")
    # Printed output of this process must not end up between two frames.
    os.dup2(2, 1)
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    config = msgspec.msgpack.decode(read_frame(source) or b"", type=Config)
    from course.isolation.probe import kept_sandboxes

    grader = _Grader(config)
    write_frame(sink, Answer())  # started: from here on a death is some submission's doing
    try:
        with kept_sandboxes():
            for frame in served(source):
                write_frame(sink, grader.answer(msgspec.msgpack.decode(frame, type=Job)))
    except (KeyboardInterrupt, BrokenPipeError):
        pass  # the coordinator is gone, or reports the interruption
    finally:
        grader.close()


def _check_worth(exercise: Exercise, worth: float) -> None:
    """Refuse scores out of other points than the exercise's: every share and every export would be wrong."""
    if not math.isclose(worth, exercise.max_points, abs_tol=1e-6):
        said = f"it says {in_points(exercise.max_points)}, and the checks are worth {format_points(worth)}."
        help_ = f"`course author build {exercise.id}` writes it anew; then `course grade rerun`."
        raise ContentError(Path(exercise.folder) / "exercise.toml", None, said, help=help_)


class _Grader:
    def __init__(self, config: Config) -> None:
        from course.catalog.load import Catalog

        self._config = config
        self._catalog = Catalog()
        self._sessions: dict[str, GradingSession] = {}
        self._versions: dict[str, str] = {}
        self._broken: dict[str, ContentError] = {}

    def answer(self, job: Job) -> Answer:
        about: dict[str, Any] = {"number": job.number, "sha256": Submission(job.files).sha256}
        try:
            version = self._checked_version(job)
            exercise = self._catalog.exercise(job.exercise)
            submission = opened(job.files, exercise)
            try:
                session = self._session(exercise)
            except ContentError as fault:
                verdict = not_graded(exercise.id, exercise.max_points, "grader_error", self._fault(fault))
                return Answer(verdict=verdict, version=version, **about)
            verdict = session.grade(submission, only=job.only)
            if verdict.error is not None and verdict.error.code == "isolation_failed":
                # Its zygote may have been killed: a new sandbox, once, before it is called our fault.
                self._sessions.pop(job.exercise).close()
                session = self._session(exercise)
                verdict = session.grade(submission, only=job.only)
            if job.asks:
                about["asked"] = {check: tuple(sorted(used)) for check, used in session.asked.items()}
            return Answer(verdict=verdict, version=version, **about)
        except CourseError as error:
            problem = Problem(error.code, error.message, error.help)
            return Answer(error=problem, exit_code=error.exit_code, **about)

    def _checked_version(self, job: Job) -> str:
        """The version of the graders here, which must be the required one."""
        from course.scoring.graders import grader_version

        if job.exercise not in self._versions:
            known = job.exercise in (*self._catalog.exercise_ids(), *self._catalog.warm_up_ids())
            self._versions[job.exercise] = (
                grader_version(self._catalog.exercise(job.exercise), self._catalog) if known else "none"
            )
        mine = self._versions[job.exercise]
        if job.version not in {"", mine}:
            raise MissingCapabilityError(
                f"The graders of {job.exercise} are version {mine} here, {job.version} where the run began.",
                help="Install the same checkout of the course on every machine, and restart the workers.",
                code="version_mismatch",
            )
        return mine

    def _session(self, exercise: Exercise) -> GradingSession:
        from course.scoring.judging.session import GradingSession

        if exercise.id in self._broken:
            raise self._broken[exercise.id]
        if exercise.id not in self._sessions:
            if len(self._sessions) == _MOST_OPEN:
                self._sessions.pop(next(iter(self._sessions))).close()
            terms, processor = self._config.terms, self._config.processor
            try:
                session = GradingSession(
                    exercise, self._catalog, scope="full", terms=terms, processor=processor
                )
                self._sessions[exercise.id] = session
                _check_worth(exercise, math.fsum(check.points for check in session.checks))
            except ContentError as fault:  # also of its worth: no submission gets to that session
                self._broken[exercise.id] = fault
                raise
        return self._sessions[exercise.id]

    def _fault(self, fault: ContentError) -> Problem:
        """What is wrong with a file of an exercise, which has another name here than at its author's."""
        file = self._catalog.content.shown(fault.file)
        where = f"{file}:{fault.line}" if fault.line else file
        return Problem("check_file", f"{where}: {fault.problem}", fault.help)

    def close(self) -> None:
        for session in self._sessions.values():
            session.close()


if __name__ == "__main__":
    main()

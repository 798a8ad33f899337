"""Deals out batches of submissions to workers elsewhere, and takes the verdicts back.

A batch that is lost with its worker is given to others one submission at a time, so that a submission which
ends its grader is soon alone. A worker also grades other submissions, and may die for other reasons: before a
submission is blamed, it is graded while nothing else is, after the rest of the class.
"""

import itertools
import queue
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from course.errors import CourseError, InternalError, MissingCapabilityError
from course.grading.cluster.worker import FORMAT, Answers, Batch, decode, encode
from course.grading.intake.students import Entry
from course.grading.running import batch as local
from course.grading.running.batch import MAX_TRIES, Graded, without_grading
from course.grading.running.grader import Job
from course.scoring.judging.submission import Terms
from course.scoring.verdict import Problem

#: Submissions in a batch, at first and at most. In between, as many as take a worker about ``_BATCH_S`` wall
#: seconds: sending a batch costs all processes together some 20 ms, and results arrive batch by batch.
_FIRST, _MOST = 8, 64
_BATCH_S = 1.0
#: Batches a worker has: one in hand, and one so that it need not wait for the next.
_AHEAD = 2
#: Bytes of files in a batch; Dask takes more, and warns.
_MOST_BYTES = 1_000_000
_TICK_S = 1.0
#: Seconds a run waits for a worker when there is none; a computing centre's queue can take that long.
_PATIENCE_S = 600.0


@dataclass(frozen=True)
class LostBatch:
    """A batch that did not come back, because its worker died.

    Attributes:
        deaths: how many workers in a row died with this batch.
    """

    deaths: int = 1


#: The outcome of a batch: the answers, its loss, or the reason why no worker can answer.
Outcome: TypeAlias = "bytes | LostBatch | CourseError"


class Workers(Protocol):
    def places(self) -> int:
        """How many batches can be graded at once; 0 if there is no worker."""

    def send(self, payload: bytes, done: Callable[[Outcome], None]) -> None:
        """Have a batch graded. ``done`` is called once, from any thread."""


def grade_on(
    workers: Workers,
    entries: Iterable[Entry],
    terms: Terms,
    version: Callable[[str], str],
    *,
    graders: bytes = b"",
    patience_s: float = _PATIENCE_S,
) -> Iterator[Graded]:
    """Verdicts on all entries that have a submission or a problem, in the order they arrive.

    Args:
        version: the version of an exercise's graders, by its id, which the workers' graders must have too.
        graders: the snapshot that ``terms`` names, packed; it is sent to a worker that lacks it.
        patience_s: wall seconds to wait for a worker when there is none.

    Raises:
        CourseError: the workers cannot grade (version, protection level, content), or there are none left.
    """
    yield from _Coordinator(workers, iter(entries), terms, version, graders, patience_s).run()


@dataclass(eq=False)
class _Work:
    entry: Entry
    job: Job
    deaths: int = 0
    alone: bool = False


@dataclass(eq=False)
class _Coordinator:
    _workers: Workers
    _entries: Iterator[Entry]
    _terms: Terms
    _version: Callable[[str], str]
    _graders: bytes
    _patience_s: float

    def __post_init__(self) -> None:
        self._numbers = itertools.count()
        self._waiting: deque[_Work] = deque()
        self._again: deque[_Work] = deque()
        self._wanting: deque[list[_Work]] = deque()
        self._suspects: deque[_Work] = deque()
        self._failure: CourseError | None = None
        self._flying: dict[int, list[_Work]] = {}
        self._arrived: queue.SimpleQueue[tuple[int, Outcome]] = queue.SimpleQueue()
        self._done: deque[Graded] = deque()
        self._places = 1
        self._size = _FIRST
        self._asked_at = self._seen_at = float("-inf")

    def run(self) -> Iterator[Graded]:
        while True:
            self._fill()
            while self._done:
                yield self._done.popleft()
            if self._failure is not None:
                raise self._failure
            if self._flying:
                self._take_in()
            elif not (self._wanting or self._waiting or self._again or self._suspects or self._done):
                return

    # -- out ------------------------------------------------------------------------------------------

    def _fill(self) -> None:
        self._count_places()
        while len(self._flying) < _AHEAD * self._places:
            # The next worker may lack the graders as well: this time they go along.
            graders = self._graders if self._wanting else b""
            batch = self._wanting.popleft() if self._wanting else self._next()
            if not batch:
                return
            number = next(self._numbers)
            self._flying[number] = batch
            message = Batch(FORMAT, self._terms, tuple(work.job for work in batch), graders)
            self._workers.send(encode(message), lambda outcome, n=number: self._arrived.put((n, outcome)))  # type: ignore[misc]

    def _next(self) -> list[_Work]:
        """The next batch to send; empty if sending must wait."""
        if self._again:
            return [self._again.popleft()]
        self._read_ahead()
        if self._waiting:
            # Smaller towards the end, so that all workers are done at about the same time.
            size = max(1, min(self._size, len(self._waiting) // (2 * self._places)))
            batch = [self._waiting.popleft()]
            room = _MOST_BYTES - _bytes(batch[0])
            while len(batch) < size and (room := room - _bytes(self._waiting[0])) >= 0:
                batch.append(self._waiting.popleft())
            return batch
        if self._suspects and not self._flying:
            self._suspects[0].alone = True
            return [self._suspects.popleft()]
        return []

    def _read_ahead(self) -> None:
        """Read enough submissions to choose the size of a batch by how many are left."""
        while len(self._waiting) < 2 * self._places * self._size:
            entry = next(self._entries, None)
            if entry is None:
                return
            if entry.submission is not None:
                self._waiting.append(_Work(entry, local.job_of(entry, self._version(entry.exercise.id))))
            elif entry.problem is not None:
                self._done.append(Graded(entry, without_grading(entry, "ungradable", entry.problem)))

    def _count_places(self) -> None:
        now = time.monotonic()
        if now - self._asked_at < _TICK_S:
            return
        places, self._asked_at = self._workers.places(), now
        if places or self._seen_at < 0:
            self._seen_at = now
        self._places = max(1, places)  # what waits on the cluster is begun by the next worker that comes
        if now - self._seen_at > self._patience_s:
            message = "The cluster has no workers left; all results so far are kept."
            advice = "Start workers, then run the same command with --resume."
            raise MissingCapabilityError(message, help=advice, code="no_workers")

    # -- back -----------------------------------------------------------------------------------------

    def _take_in(self) -> None:
        try:
            number, outcome = self._arrived.get(timeout=_TICK_S)
        except queue.Empty:
            return
        batch = self._flying.pop(number)
        if isinstance(outcome, LostBatch):
            self._lost(batch, outcome)
        elif isinstance(outcome, bytes):
            self._answered(batch, decode(outcome, Answers))
        else:
            self._failure = outcome

    def _answered(self, batch: list[_Work], reply: Answers | None) -> None:
        if reply is None:
            message = "A worker of the cluster answers in another version of the protocol."
            advice = "Install the same checkout of the course on every machine, and restart the workers."
            raise MissingCapabilityError(message, help=advice, code="version_mismatch")
        if reply.wanting and self._graders:
            self._wanting.append(batch)
            return
        if reply.seconds > 0:
            self._size = max(1, min(_MOST, int(_BATCH_S * len(batch) / reply.seconds)))
        for work, answer in zip(batch, reply.answers, strict=False):
            if answer.error is not None:
                problem = answer.error
                said = Problem(problem.code, f"Worker on {reply.host}: {problem.message}", problem.help)
                self._failure = local.as_error(said, answer.exit_code)
                return
            if not answer.is_about(work.job):
                self._lost([work], LostBatch())
            elif answer.verdict is None:
                self._blame(work, local.KILLED_ITS_GRADER)
            else:
                self._done.append(Graded(work.entry, answer.verdict, answer.version))
        if len(reply.answers) < len(batch):
            raise InternalError(f"The worker on {reply.host} left submissions out.")

    def _lost(self, batch: list[_Work], loss: LostBatch) -> None:
        if len(batch) > 1:
            self._again += batch
            return
        (work,) = batch
        work.deaths += loss.deaths
        if work.alone and work.deaths >= MAX_TRIES:
            problem = Problem(
                "worker_died",
                f"Workers of the cluster died {work.deaths} times on this submission.",
                "Grade it on one machine, without the cluster; it is marked for regrading.",
            )
            self._blame(work, problem)
        elif work.deaths >= MAX_TRIES - 1:
            self._suspects.append(work)
        else:
            self._again.append(work)

    def _blame(self, work: _Work, problem: Problem) -> None:
        self._done.append(Graded(work.entry, without_grading(work.entry, "grader_error", problem)))


def _bytes(work: _Work) -> int:
    return sum(map(len, work.job.files.values()))

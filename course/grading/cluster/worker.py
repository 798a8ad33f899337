"""A Dask worker's part: it passes each batch to a grader process that it keeps warm.

The grader is the same program that ``course grade run`` starts on one machine, with its checks, its sandbox
and its protection level. The Dask worker only carries bytes to it: no student's code, no check and no
secret is ever in the worker's own process, which a cluster may reach over the network.

Importing this module is all a worker needs; it imports nothing of Dask.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import socket
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator
from typing import TypeVar

import msgspec

from course.errors import CourseError, MissingCapabilityError
from course.grading.running.batch import WarmGrader, start_grader
from course.grading.running.grader import Answer, Config, Job
from course.grading.running.snapshot import Snapshot, frozen, in_use
from course.scoring.judging.submission import Terms
from course.scoring.verdict import Problem

# ---
# The messages between a coordinator and the workers of a cluster.
#
# A task is a function that both sides have, by name, with one argument of bytes; its result is bytes. So Dask
# pickles only a name and a string of bytes: no object of this course, and nothing from a submission, is ever
# unpickled. The content of the bytes is checked against these types.


T = TypeVar("T", "Batch", "Answers")

#: Grows when a message changes its meaning.
FORMAT = 4


class Batch(msgspec.Struct, frozen=True):
    """Submissions for one worker, and how to grade them.

    Attributes:
        format: the sender's ``FORMAT``.
        graders: the snapshot that ``terms`` names, packed; empty until the worker asked for it.
    """

    format: int
    terms: Terms
    jobs: tuple[Job, ...]
    graders: bytes = b""


class Answers(msgspec.Struct, frozen=True):
    """A worker's reply to a batch.

    Attributes:
        host: the worker's machine, for messages.
        answers: one for each job, in order, but none after one that is an error. An answer with neither
            verdict nor error is of a submission that no grader survived.
        seconds: wall time the worker spent on the batch.
        wanting: the worker lacks the snapshot, and so has no answers.
    """

    format: int
    host: str
    answers: tuple[Answer, ...]
    seconds: float
    wanting: bool = False


def encode(message: Batch | Answers) -> bytes:
    return msgspec.msgpack.encode(message)


def decode(payload: bytes, kind: type[T]) -> T | None:
    """A message of this kind; None if it is none, or of another format."""
    try:
        message = msgspec.msgpack.decode(payload, type=kind)
    except msgspec.MsgspecError:
        return None
    return message if message.format == FORMAT else None


#: Seconds after which a grader without work ends, because the workers of an external cluster outlive the run.
IDLE_S = 60.0

_idle: list[_WarmGrader] = []
_lock = threading.Lock()
#: Snapshots that are kept, for runs that go on at the same time; about 3 MB each.
_MOST_SNAPSHOTS = 4
_snapshots: deque[contextlib.ExitStack] = deque()


def grade_batch(payload: bytes) -> bytes:
    """Grade a batch; both it and the answers are in the form that crosses the wire."""
    started, wanting = time.monotonic(), False
    batch = decode(payload, Batch)
    try:
        if batch is None:
            raise MissingCapabilityError(
                "The worker speaks another version of the protocol than the coordinator.",
                help="Install the same checkout of the course on every machine of the cluster, and restart"
                " the workers.",
                code="version_mismatch",
            )
        wanting = not _unpacked(batch)
        answers = () if wanting else tuple(_answers(batch))
    except CourseError as error:
        answers = (refusal(error),)
    return encode(Answers(FORMAT, socket.gethostname(), answers, time.monotonic() - started, wanting))


def _unpacked(batch: Batch) -> bool:
    """Whether the batch's snapshot is here; the latest few are kept."""
    sha256 = batch.terms.graders
    with _lock:
        if in_use(sha256) is not None:
            return True
        if not batch.graders:
            return False
        kept = contextlib.ExitStack()
        kept.enter_context(frozen(Snapshot.of(batch.graders, sha256)))
        _snapshots.append(kept)
        if len(_snapshots) > _MOST_SNAPSHOTS:
            _snapshots.popleft().close()
        return True


def _forget() -> None:
    while _snapshots:
        _snapshots.pop().close()


atexit.register(_forget)


def refusal(error: CourseError) -> Answer:
    """The answer of a worker that can give none."""
    return Answer(error=Problem(error.code, error.message, error.help), exit_code=error.exit_code)


def _answers(batch: Batch) -> Iterator[Answer]:
    grader = _take(Config(batch.terms, 0))
    try:
        for job in batch.jobs:
            answer = grader.answer(job)
            yield answer
            if answer.error is not None:
                grader.close()
                return
    except CourseError as error:
        yield refusal(error)
    finally:
        _give_back(grader)


class _WarmGrader(WarmGrader):
    """One that ends when it has had no work for a while; its processor is chosen when it starts."""

    _seat: socket.socket | None = None
    _retirement: threading.Timer | None = None

    def _launch(self) -> subprocess.Popen[bytes]:
        number, self._seat = _take_seat()
        return start_grader(msgspec.structs.replace(self.config, processor=number))

    def close(self, patience_s: float = 0.0) -> None:
        super().close(patience_s)
        if self._seat is not None:
            self._seat.close()
            self._seat = None

    def retire_later(self) -> None:
        """End the process when it has had no work for a while."""
        self._retirement = threading.Timer(IDLE_S, self._retire)
        self._retirement.daemon = True
        self._retirement.start()

    def stay(self) -> None:
        """Note that there is work."""
        if self._retirement is not None:
            self._retirement.cancel()

    def _retire(self) -> None:
        with _lock:
            if self not in _idle:
                return
            _idle.remove(self)
        self.close()


def _take(config: Config) -> _WarmGrader:
    """A grader for one thread of this worker, warm if there is one; those of another run are ended."""
    with _lock:
        others = [grader for grader in _idle if grader.config != config]
        mine = [grader for grader in _idle if grader.config == config]
        taken = mine.pop() if mine else _WarmGrader(config)
        _idle[:] = mine
    taken.stay()
    for grader in others:
        grader.stay()
        grader.close()
    return taken


def _give_back(grader: _WarmGrader) -> None:
    with _lock:
        _idle.append(grader)
    grader.retire_later()


def _take_seat() -> tuple[int, socket.socket | None]:
    """A number that no other grader on this machine has; it picks the processor.

    It is held by a name that the kernel frees however this process ends. Only Linux pins a process to a
    processor, so elsewhere the number means nothing.
    """
    if sys.platform != "linux":
        return 0, None
    for number in range(4096):
        seat = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            seat.bind(f"\0course-grader-{os.getuid()}-{number}")
        except OSError:
            seat.close()
        else:
            return number, seat
    return 0, None


def dask_setup(_worker: object) -> None:
    """Dask calls this in each worker of a local cluster: Ctrl-C is for the coordinator, which ends them."""
    import signal

    with contextlib.suppress(ValueError):  # not the main thread: then nothing was to be done
        signal.signal(signal.SIGINT, signal.SIG_IGN)

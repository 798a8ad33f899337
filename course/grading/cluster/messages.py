"""The messages between a coordinator and the workers of a cluster.

A task is a function that both sides have, by name, with one argument of bytes; its result is bytes. So Dask
pickles only a name and a string of bytes: no object of this course, and nothing from a submission, is ever
unpickled. The content of the bytes is checked against these types.
"""

from __future__ import annotations

from typing import TypeVar

import msgspec

from course.grading.running.grader import Answer, Job
from course.scoring.judging.terms import Terms

__all__ = ["FORMAT", "Answers", "Batch", "decode_answers", "decode_batch", "encode"]

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
    """A message as it crosses."""
    return msgspec.msgpack.encode(message)


def decode_batch(payload: bytes) -> Batch | None:
    """The batch in ``payload``; None if it is of another format."""
    return _decode(payload, Batch)


def decode_answers(payload: bytes) -> Answers | None:
    """The answers in ``payload``; None if they are of another format."""
    return _decode(payload, Answers)


def _decode(payload: bytes, kind: type[T]) -> T | None:
    try:
        message = msgspec.msgpack.decode(payload, type=kind)
    except msgspec.MsgspecError:
        return None
    return message if message.format == FORMAT else None

"""Where a student's code is when it does not answer; used only at home, where nothing is hidden.

The worker is sampled a few times. A function that ends in between is not the one that hangs, so only the
calls that are present in every sample count, and in the innermost of them the loop that it was in each time.
"""

from __future__ import annotations

import ast
import contextlib
from time import sleep
from typing import TYPE_CHECKING, Any

from course.isolation.deadline import Deadline
from course.isolation.failures import StudentFailure
from course.isolation.inside import wire
from course.isolation.reports import raised

if TYPE_CHECKING:
    from course.isolation.levels import Handle

__all__ = ["LOOP", "where_it_hangs"]

#: ``StudentFailure.type`` of a timeout whose line is the first one of a loop.
LOOP = "loop"
_BETWEEN_S = 0.05  # a step of a simulation takes far less, so it is not mistaken for the hang
_ANSWER_S = 1.0
_RECV = 1 << 12
_MOST = 1 << 16  # bytes; an answer has some hundreds


def where_it_hangs(handle: Handle, begun: bytes, main: str, source: bytes) -> StudentFailure | None:
    """The timeout with the line it hangs at; None if the worker does not say, or cannot be asked.

    Args:
        handle: the worker, which is to be ended afterwards.
        begun: what came from it and was not read yet.
        main: name of the submission's file.
        source: what is in it.
    """
    if wire.LOOK is None:
        return None
    for _ in range(wire.LOOKS):
        handle.look()
        sleep(_BETWEEN_S)
    said = _answer(handle, begun)
    text = source.decode("utf-8", "replace")
    failure = raised(said, main, text.splitlines()) if said is not None else None
    if failure is None or failure.line is None:
        return None
    lines = said.get("lines") if isinstance(said, dict) else None
    seen = [line for line in lines if type(line) is int] if isinstance(lines, list) else []
    head = _loop_around(text, seen or [failure.line])
    return StudentFailure(
        "timeout",
        type=LOOP if head else "",
        line=head or failure.line,
        traceback=failure.traceback,
    )


def _answer(handle: Handle, buffer: bytes) -> Any:
    """The place in the code that the worker reports; None if it sends nothing that can be read as one."""
    codec, deadline = wire.Codec(), Deadline(_ANSWER_S)
    deadline.watch(handle)
    while not deadline.passed() and len(buffer) < _MOST:
        if len(buffer) >= wire.HEADER.size:
            length, kind = wire.HEADER.unpack_from(buffer)
            if not 0 < length < _MOST:
                return None
            if len(buffer) >= 4 + length:
                if kind == wire.Kind.STUCK:
                    with contextlib.suppress(wire.WireError):
                        return codec.decode(buffer[wire.HEADER.size : 4 + length])
                    return None
                buffer = buffer[4 + length :]
                continue
        try:
            received = handle.channel.recv(_RECV)
        except (BlockingIOError, TimeoutError):
            # On a busy machine several looks may have reached it as one.
            handle.look()
            continue
        except OSError:
            return None
        if not received:
            return None
        buffer += received
    return None


def _loop_around(text: str, lines: list[int]) -> int | None:
    """The first line of the smallest loop that all these lines are in; None if there is none."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return None
    loops = [
        (node.end_lineno - node.lineno, node.lineno)
        for node in ast.walk(tree)
        if isinstance(node, ast.While | ast.For) and node.end_lineno is not None
        if all(node.lineno <= line <= node.end_lineno for line in lines)
    ]
    return min(loops)[1] if loops else None

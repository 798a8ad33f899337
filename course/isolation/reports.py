"""A worker's report about an exception, read as an untrusted claim."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from course.isolation.failures import StudentFailure
from course.printable import one_line

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["claimed_line", "claimed_names", "claimed_text", "raised"]

_MAX_FRAMES = 12  # of a traceback


def raised(value: Any, main: str, source: Sequence[str]) -> StudentFailure | None:
    """The exception that a report is about; None if it is not a report.

    Args:
        value: received over the wire, and not trusted.
        main: name of the submission's file.
        source: its lines, which alone are quoted.
    """
    if not isinstance(value, dict):
        return None
    kind = claimed_text(value.get("type"), 100)
    message = claimed_text(value.get("message"))
    if kind == "UnsupportedValue":
        return StudentFailure("protocol", type=kind, message=message)
    frames = [
        (frame[1], claimed_text(frame[2], 100))
        for frame in _items(value.get("frames"))
        if isinstance(frame, list) and len(frame) == 3 and claimed_text(frame[0]) == main
        if _is_line(frame[1], source)
    ]
    line = frames[-1][0] if frames else None
    if _is_line(value.get("line"), source):
        line = value["line"]
    bases = [claimed_text(base, 100) for base in _items(value.get("bases"))]
    return StudentFailure(
        "memory" if "MemoryError" in bases else "error",
        type=kind,
        message=message,
        line=line,
        traceback="\n".join(
            f"{main}:{number} in {function}\n    {claimed_text(source[number - 1].strip(), 200)}".rstrip()
            for number, function in frames
        ),
        bases=bases,
    )


def claimed_text(value: Any, limit: int = 2000) -> str:
    """Text that can be shown on one line; empty if it is not text."""
    return one_line(value, limit) if isinstance(value, str) else ""


def claimed_names(value: Any) -> list[str]:
    """Names of functions; none if it is not a list of such."""
    names = value[:1000] if isinstance(value, list) else []
    return [name for name in names if isinstance(name, str)]


def claimed_line(value: Any, source: Sequence[str]) -> int | None:
    """A line of the file; None if it is none."""
    return value if _is_line(value, source) else None


def _items(value: Any) -> list[Any]:
    """The last items of a list; none if it is not a list."""
    return value[-_MAX_FRAMES:] if isinstance(value, list) else []


def _is_line(number: Any, source: Sequence[str]) -> bool:
    """Whether the file has that line: any other number would be a way to carry a value out."""
    return type(number) is int and 0 < number <= len(source)

"""Failures on the untrusted side of the wire, as the trusted side sees them.

IsolationError          our side could not provide what it promised: never a student's fault
StudentFailure          the student's code, or the process it ran in, gave no value
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal, Self

from course.printable import one_line

FailureKind = Literal["error", "timeout", "memory", "crash", "protocol", "missing"]


class IsolationError(Exception):
    """The protected process could not be started, or does not follow the protocol."""


@dataclass(eq=False)
class StudentFailure(Exception):  # noqa: N818 - it is an outcome, named for what it says
    """The student's code gave no value.

    Attributes:
        kind: "error" (it raised), "timeout", "memory", "crash" (its process died), "protocol" (it returned
            what cannot cross to the grader, or its process spoke out of turn) or "missing" (no such
            function).
        type: name of the exception's class, for "error"; name of the function, for "missing"; "loop" for a
            "timeout" whose line is the first one of a loop.
        message: the exception's own words. They may repeat a hidden input, so they never reach a message.
        line: line of the student's file where it arose, 1 first; where it is known.
        traceback: the student's own frames, as text.
        bases: names of the classes the exception derives from, its own included.
        places: how ``line`` is named in messages to the student; None if unknown here.
        why: of a "missing" function, what kept it from being loaded.
    """

    kind: FailureKind
    _: KW_ONLY
    type: str = ""
    message: str = ""
    line: int | None = None
    traceback: str = ""
    bases: Sequence[str] = ()
    places: Any = None
    why: StudentFailure | None = None

    def __post_init__(self) -> None:
        super().__init__(self.kind, self.type, self.message)
        self.bases = tuple(self.bases) or (self.type,)

    @classmethod
    def missing(cls, function: str, why: StudentFailure | None = None) -> Self:
        """The submission has no callable of this name.

        Args:
            why: what kept it from being loaded, if the file has it.
        """
        return cls("missing", type=function, message=f"no function {function!r}", why=why)

    def is_a(self, exception: str) -> bool:
        """Whether the student's code raised this exception or one derived from it."""
        return self.kind == "error" and exception in self.bases


# ---
# A worker's report about an exception, read as an untrusted claim.


_MAX_FRAMES = 12  # of a traceback
#: The worker's refusal of an import, and the only words that it has: they are told without "raises".
NOT_DECLARED = "ImportNotDeclaredError"
_REFUSED_IMPORT = re.compile(
    r"this exercise does not allow importing '[^\s']{1,100}'"
    r" \(allowed: the standard library(, [^\s,]{1,100})+\)"
)


def raised(value: Any, main: str, source: Sequence[str]) -> StudentFailure | None:
    """The exception that a report is about; None if it is not a report.

    Args:
        value: received over the wire, and not trusted.
        source: its lines, which alone are quoted.
    """
    if not isinstance(value, dict):
        return None
    kind = claimed_text(value.get("type"), 100)
    message = claimed_text(value.get("message"))
    if kind == "UnsupportedValue":
        return StudentFailure("protocol", type=kind, message=message)
    if kind == NOT_DECLARED and not _REFUSED_IMPORT.fullmatch(message):
        kind = "ImportError"  # a class of its own by that name, which says what it likes
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

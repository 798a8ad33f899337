"""Failures on the untrusted side of the wire, as the trusted side sees them.

IsolationError          our side could not provide what it promised: never a student's fault
StudentFailure          the student's code, or the process it ran in, gave no value
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Self

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["FailureKind", "IsolationError", "StudentFailure"]

FailureKind = Literal["error", "timeout", "memory", "crash", "protocol", "missing"]


class IsolationError(Exception):
    """The protected process could not be started, or does not follow the protocol."""


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

    def __init__(
        self,
        kind: FailureKind,
        *,
        type: str = "",  # noqa: A002 - the field's name
        message: str = "",
        line: int | None = None,
        traceback: str = "",
        bases: Sequence[str] = (),
    ) -> None:
        super().__init__(kind, type, message)
        self.kind = kind
        self.type = type
        self.message = message
        self.line = line
        self.traceback = traceback
        self.bases = tuple(bases) or (type,)
        self.places: Any = None
        self.why: StudentFailure | None = None

    @classmethod
    def missing(cls, function: str, why: StudentFailure | None = None) -> Self:
        """The submission has no callable of this name.

        Args:
            why: what kept it from being loaded, if the file has it.
        """
        failure = cls("missing", type=function, message=f"no function {function!r}")
        failure.why = why
        return failure

    def is_a(self, exception: str) -> bool:
        """Whether the student's code raised this exception or one derived from it."""
        return self.kind == "error" and exception in self.bases

"""The content of a gradebook, as types."""

from collections.abc import Set
from dataclasses import dataclass
from typing import Any

import msgspec

from course.scoring.verdict import Verdict

#: How the note of a verdict begins that says which functions are only in a file that was not graded.
ELSEWHERE = "Written in another file only, and not graded: "


@dataclass(frozen=True, order=True)
class Key:
    student: str
    exercise: str
    submission_sha256: str
    grader_version: str
    seed: int


@dataclass(frozen=True)
class Result:
    """One stored result.

    Attributes:
        graded_at: UTC, ISO 8601.
        run: number of the grading or regrading it came from.
        number: grows with time; the newest result of a student and exercise is the one that counts.
    """

    key: Key
    verdict: Verdict
    graded_at: str = ""
    run: int = 0
    number: int = 0


class GradedExercise(msgspec.Struct, frozen=True):
    """An exercise as it was when it was graded. ``pass_share`` is a share of ``max_points``."""

    id: str
    title: str
    max_points: float
    pass_share: float
    position: int


class PlatformIdentity(msgspec.Struct, frozen=True):
    """A student's identity in the system a class was downloaded from.

    Attributes:
        source: "canvas", "moodle" or "gradescope".
        key: the student's number there.
        name: as that system spells it.
    """

    source: str
    key: str
    name: str = ""
    email: str = ""
    sid: str = ""


class SubmittedAt(msgspec.Struct, frozen=True):
    """A time of submission, by one witness.

    Attributes:
        submission_sha256: of the submission; empty for any by this student.
        source: the witness: "gradescope", "list", "mtime", or "canvas-late" (which only says: late).
        at: seconds since 1970, UTC; None if the witness does not say.
    """

    student: str
    exercise: str
    submission_sha256: str
    source: str
    at: float | None


class Looked(msgspec.Struct, frozen=True):
    """Whose work was looked at for an exercise.

    Attributes:
        whole: the class, but for ``names``; otherwise these alone.
        named: it was asked for by name, so that it can be missing whoever handed it in.
    """

    whole: bool = False
    named: bool = False
    names: frozenset[str] = frozenset()

    def at(self, student: str) -> bool:
        return self.whole != (student in self.names)

    def having(self, students: Set[str]) -> "Looked":
        names = self.names - students if self.whole else self.names | students
        return msgspec.structs.replace(self, names=names)

    def without(self, students: Set[str]) -> "Looked":
        names = self.names | students if self.whole else self.names - students
        return msgspec.structs.replace(self, names=names)


class Override(msgspec.Struct, frozen=True):
    """A score an instructor set. ``score`` None lifts an earlier one."""

    student: str
    exercise: str
    score: float | None
    reason: str
    at: str = ""


class Decision(msgspec.Struct, frozen=True):
    """A change of grades: who made it, and why.

    Attributes:
        at: UTC, ISO 8601; empty for now.
        who: the name of the account; empty for the one this runs under.
        kind: "override", "lift", "assign", "late", "rerun", "resume" (another submission
            counts now), "roster" or "salvage".
        student, exercise: what it is about; empty for a whole class.
        before, after: in words or JSON, what counted and what counts.
    """

    at: str
    who: str
    kind: str
    student: str
    exercise: str
    reason: str
    before: str
    after: str


class Run(msgspec.Struct, frozen=True):
    """A grading ("run"), a regrading ("rerun") or files assigned by hand ("assign"), with its options."""

    number: int
    kind: str
    started_at: str
    options: dict[str, Any]

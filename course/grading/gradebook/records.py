"""The content of a gradebook, as types."""

from collections.abc import Set
from dataclasses import dataclass
from typing import Any

import msgspec

from course.scoring.verdict import Verdict


@dataclass(frozen=True, order=True)
class Key:
    student: str
    exercise: str
    submission_sha256: str
    grader_version: str
    seed: int


@dataclass(frozen=True)
class Result:
    """One stored result, graded at a time (UTC, ISO 8601) in the grading or regrading of that number.
    ``number`` grows with time; the newest result of a student and exercise is the one that counts."""

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
    """A student's identity in the system a class was downloaded from ("canvas", "moodle" or "gradescope"):
    the number there, and the name as that system spells it."""

    source: str
    key: str
    name: str = ""
    email: str = ""
    sid: str = ""


class SubmittedAt(msgspec.Struct, frozen=True):
    """A time of submission (seconds since 1970, UTC; None if not said), by one witness: "gradescope",
    "list", "mtime", or "canvas-late", which only says: late. Without a digest it is of any submission by
    this student."""

    student: str
    exercise: str
    submission_sha256: str
    source: str
    at: float | None


class Looked(msgspec.Struct, frozen=True):
    """Whose work was looked at for an exercise: the class without ``names``, or these alone. One that was
    asked for by name can be missing whoever handed it in."""

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
    """A change of grades: who made it (empty for the account this runs under), when (UTC, ISO 8601; empty
    for now), and why.

    ``kind`` is "override", "lift", "assign", "late", "rerun", "resume" (another submission counts now),
    "roster" or "salvage"; without student and exercise it is about a whole class. What counted before and
    what counts is told in words or JSON.
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

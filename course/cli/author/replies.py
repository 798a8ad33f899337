"""The replies of ``course author ... --json``, as types."""

from __future__ import annotations

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Envelope


class AuthorProblem(msgspec.Struct, frozen=True):
    """One thing that is wrong; ``code`` is a stable name of the broken rule."""

    file: str
    line: int | None
    code: str
    message: str
    help: str


class AuthorNew(Envelope, tag="course.author-new/1", frozen=True, kw_only=True):
    """``kind`` is "exercise", "warm-up", "lesson", "question" or "scene"."""

    kind: str
    id: str
    files: tuple[str, ...]


class AuthorBuild(Envelope, tag="course.author-build/1", frozen=True, kw_only=True):
    """The files that were computed, relative to the course."""

    files: tuple[str, ...]


class AuthorCheck(Envelope, tag="course.author-check/1", frozen=True, kw_only=True):
    """``graded`` counts the stubs, solutions, variants and mutants that were scored to find out."""

    course: CourseRef
    lessons: tuple[str, ...]
    exercises: tuple[str, ...]
    questions: tuple[str, ...]
    scenes: tuple[str, ...]
    checks: int
    graded: int
    isolation: str
    seconds: float
    problems: tuple[AuthorProblem, ...]


class CoverageRow(msgspec.Struct, frozen=True, kw_only=True):
    """A part of the chapter and the places of the course that have it."""

    section: str
    lines: str
    kind: str
    what: str
    word: str
    where: tuple[str, ...]


class AuthorCoverage(Envelope, tag="course.author-coverage/1", frozen=True, kw_only=True):
    """``written`` is the page that was made, if one was asked for."""

    source_lines: int
    parts: tuple[CoverageRow, ...]
    written: str | None
    problems: tuple[AuthorProblem, ...]


class MutantRow(msgspec.Struct, frozen=True, kw_only=True):
    """A wrong solution and what the student who wrote it would read."""

    exercise: str
    file: str
    task: str
    misconception: str
    check: str
    diagnosis: str | None
    caught_by: tuple[str, ...]
    lost: float
    message: str
    help: str
    faults: tuple[str, ...]


class AuthorMutants(Envelope, tag="course.author-mutants/1", frozen=True, kw_only=True):
    mutants: tuple[MutantRow, ...]


class AuthorPack(Envelope, tag="course.author-pack/1", frozen=True, kw_only=True):
    course: CourseRef
    output: str
    sha256: str
    solutions: dict[str, tuple[str, ...]]


class AuthorPictures(Envelope, tag="course.author-pictures/1", frozen=True, kw_only=True):
    """``stale`` names the pictures that were not up to date; without ``--check`` they are now."""

    stale: tuple[str, ...]

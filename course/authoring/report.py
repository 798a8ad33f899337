"""The result of an audit: problems with file, line and fix, and the numbers of checked parts."""

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import msgspec

from course.catalog.reading import Keys, LineMap
from course.errors import ContentError

#: Called with steps done, steps in all, and what is being done now.
Progress: TypeAlias = "Callable[[int, int, str], None]"
#: Called with the place of a value, what is wrong with it, and the fix.
About: TypeAlias = "Callable[[Keys, str, str], None]"


#: Codes of what is out of date.
_BUILT = frozenset({"points", "slow", "stale"})


class AuthorProblem(msgspec.Struct, frozen=True):
    """One thing that is wrong; ``code`` is a stable name of the broken rule."""

    file: str  # relative to the course's root where it lies below it
    line: int | None  # from 1, or None where no single line is to blame
    code: str
    message: str
    help: str

    @property
    def where(self) -> str:
        """``file:line`` as editors understand it."""
        return f"{self.file}:{self.line}" if self.line else self.file


@dataclass(frozen=True, slots=True)
class AuditReport:
    """The outcome of an audit.

    Attributes:
        problems: as ``Findings.sorted`` has them; empty if there are none.
        lessons, exercises, questions, scenes: ids that were looked at.
        checks: number of checks, public and hidden.
        graded: number of submissions that were graded to find out.
        isolation: protection level they ran at; empty if none ran.
    """

    problems: tuple[AuthorProblem, ...]
    lessons: tuple[str, ...] = ()
    exercises: tuple[str, ...] = ()
    questions: tuple[str, ...] = ()
    scenes: tuple[str, ...] = ()
    checks: int = 0
    graded: int = 0
    isolation: str = ""
    seconds: float = 0.0

    @property
    def ok(self) -> bool:
        return not self.problems


@dataclass(slots=True)
class Findings:
    """Problems as they are collected.

    Args:
        root: paths below it are reported relative to it.
    """

    root: Path
    problems: list[AuthorProblem] = field(default_factory=list)

    def add(self, file: Path | str, line: int | None, code: str, message: str, fix: str) -> None:
        """Note one problem; the same one twice is noted once."""
        path = Path(file)
        shown = path.relative_to(self.root).as_posix() if path.is_relative_to(self.root) else str(path)
        problem = AuthorProblem(shown, line, code, message, fix)
        if problem not in self.problems:
            self.problems.append(problem)

    def about(self, path: Path, lines: LineMap, code: str) -> About:
        """Notes problems of one kind with the values of one TOML file, each where the value stands."""
        return lambda where, message, fix: self.add(path, lines.line(where), code, message, fix)

    def add_error(self, error: ContentError) -> None:
        """Note what the loader refused."""
        self.add(error.file, error.line, "content", error.problem, error.help)

    @contextlib.contextmanager
    def refusals(self) -> Iterator[None]:
        """Note what the loader refuses, and go on after it."""
        try:
            yield
        except ContentError as error:
            self.add_error(error)

    def of(self, *codes: str) -> bool:
        """True if a problem with one of these codes was noted."""
        return any(problem.code in codes for problem in self.problems)

    def sorted(self) -> tuple[AuthorProblem, ...]:
        """By file and line; what `course author build` mends comes last, since it follows from the rest."""
        return tuple(
            sorted(self.problems, key=lambda p: (p.code in _BUILT, p.file, p.line or 0, p.code, p.message))
        )

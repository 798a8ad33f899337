"""Every error this course raises on purpose, and the exit code each one ends the program with.

    CourseError                 70  anything below; never raised itself
    |-- UsageError               2  the command was called with something it cannot use
    |-- UngradableError          3  there is nothing to grade: no file, unreadable, refused archive
    |-- MissingCapabilityError   4  this machine lacks an extra, an engine, a version, a protection level
    |-- NotFoundError            5  no such exercise, lesson, workspace
    |-- IntegrityError           7  a gradebook or archive whose checksum fails
    |-- ContentError            70  a file of the course itself is wrong (names the file and the line)
    `-- InternalError           70  our fault

An error is raised where the fact is known and rendered once, in ``course.cli``. ``message`` says what is
the case, ``help`` what to do about it; neither needs the other to be understood.
"""

import re
from pathlib import Path

#: The exit code of a command that was stopped with Ctrl-C.
INTERRUPTED = 130


#: Longer than any name of a file.
_ENDLESS_WORD = re.compile(r"([^\s/]{100})[^\s/]{200,}")


class CourseError(Exception):
    """Base of every deliberate error.

    Args:
        message: one sentence that says what is wrong.
        help: one sentence that says what to do; empty when there is nothing to do.
        code: a stable name for scripts (``error.code`` in ``--json``).
    """

    exit_code = 70
    default_code = "internal"

    def __init__(self, message: str, *, help: str = "", code: str = "") -> None:  # noqa: A002
        # What is quoted of a stranger's file may be as long as the file.
        message, help = (_ENDLESS_WORD.sub(r"\1...", text) for text in (message, help))  # noqa: A001
        super().__init__(message)
        self.message = message
        self.help = help
        self.code = code or self.default_code


class UsageError(CourseError):
    """The command was called with something it cannot use."""

    exit_code = 2
    default_code = "usage"


class UngradableError(CourseError):
    """There is nothing to grade; ``code`` is the reason that reaches the report."""

    exit_code = 3
    default_code = "ungradable"


class MissingCapabilityError(CourseError):
    """This machine lacks an extra, an engine, a version or a protection level."""

    exit_code = 4
    default_code = "environment"


class NotFoundError(CourseError):
    """No such exercise, lesson, scene or workspace."""

    exit_code = 5
    default_code = "not_found"


class IntegrityError(CourseError):
    """A gradebook or archive is damaged. Damage is detected; a forger who recomputes the sum is not."""

    exit_code = 7
    default_code = "integrity"


class ContentError(CourseError):
    """A file of the course is wrong.

    Args:
        file: the file at fault.
        line: 1-based line, or None when the fault has no single line (a missing file, say).
        problem: what is wrong there.
        help: the fix.
    """

    exit_code = 70
    default_code = "content"

    def __init__(self, file: Path, line: int | None, problem: str, *, help: str) -> None:  # noqa: A002
        where = f"{file}:{line}" if line else str(file)
        super().__init__(f"{where}: {problem}", help=help)
        self.file = file
        self.line = line
        self.problem = problem


class InternalError(CourseError):
    """Our fault: a bug of the course, not of what it was given."""

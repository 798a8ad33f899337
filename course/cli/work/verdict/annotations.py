"""Findings as lines that other programs read: annotations on GitHub, and the ``file:line:`` of compilers."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from course.cli.frame.here import cwd
from course.errors import UsageError
from course.printable import steady, unheeded
from course.scoring.numbers import numbers_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.cli.frame.here import Here
    from course.cli.frame.terminal.console import Console
    from course.cli.work.chosen import StudentWork
    from course.errors import CourseError
    from course.scoring.verdict import CheckResult, Verdict

__all__ = ["FORMATS", "annotate", "annotate_error", "github", "known_format", "line_of", "unread_line"]

FORMATS = ("text", "github", "lines")

#: How a student's frame begins in a traceback, as ``StudentFailure`` has it.
_FRAME = re.compile(r"^\S+\.py:(\d+) in ", re.MULTILINE)


def known_format(name: str) -> str:
    """The name of a format.

    Raises:
        UsageError: there is none of that name.
    """
    if name not in FORMATS:
        raise UsageError(f"There is no format {name[:20]!r}.", help=f"Formats: {', '.join(FORMATS)}.")
    return name


def annotate(console: Console, here: Here, work: StudentWork, verdict: Verdict, form: str) -> None:
    """One line for each cause of a failed check; a cause of several is said once."""
    said = set()
    for check in verdict.checks:
        if check.status in {"pass", "skip"}:
            continue
        line = _line_of(work, check)
        if (line, check.message) in said:
            continue
        said.add((line, check.message))
        level = "warning" if check.status == "grader_error" else "error"
        title = f"{check.title} [{check.id}]"
        console.raw(_shown(form, level, _path(here, work, form), line, title, "\n".join(_words(check))))


def annotate_error(console: Console, here: Here, work: StudentWork, error: CourseError, form: str) -> None:
    """One line for the error that keeps the whole file from being checked."""
    text = f"{error.message}\n{error.help}".strip()
    line = unread_line(work.source) if work.notebook is None else 1
    title = f"{work.exercise.title} [{error.code}]"
    console.raw(_shown(form, "error", _path(here, work, form), line, title, text))


def github(level: str, file: str, line: int, title: str, message: str) -> str:
    """A workflow command of GitHub's, which puts a message beside a line of a file.

    ``::error file={name},line={line},title={title}::{message}``, as "Workflow commands for GitHub Actions"
    in GitHub's documentation has it. The escaped characters are those that the runner un-escapes
    (``_escapeDataMappings`` and ``_escapePropertyMappings`` in ``actions/runner``,
    src/Runner.Common/ActionCommand.cs): a percent sign and line ends everywhere, colon and comma in
    properties, which they would end.
    """
    return f"::{level} file={_property(file)},line={line},title={_property(title)}::{_data(message)}\n"


def _shown(form: str, level: str, file: str, line: int, title: str, message: str) -> str:
    # Text from a student's exception must not control a terminal that shows the log.
    title, message = steady(title), steady(message)
    if form == "github":
        return github(level, file, line, title, message)
    return unheeded(f"{file}:{line}: {level}: {' '.join(f'{title}: {message}'.split())}\n")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")


def _words(check: CheckResult) -> Iterator[str]:
    yield check.message or f"This check ended in: {check.status}."
    if check.help:
        yield check.help
    yield from (f"{label}: {text}" for label, text in numbers_of(check) if label != "diagnosis")


def unread_line(source: bytes | str) -> int:
    """The line where Python stops parsing a file; 1 if it parses all of it."""
    try:
        compile(source, "", "exec", dont_inherit=True)
    except (SyntaxError, ValueError) as problem:
        return getattr(problem, "lineno", None) or 1
    return 1


def _line_of(work: StudentWork, check: CheckResult) -> int:
    text = work.data.decode("utf-8", "replace")
    return line_of(text, check, traced=work.notebook is None)


def line_of(text: str, check: CheckResult, *, traced: bool = True) -> int:
    """The line where the student's code raised; else where the function begins, even in a notebook's JSON.

    Args:
        text: the file.
        traced: the lines of a traceback are lines of this file.
    """
    if traced and (frames := _FRAME.findall(check.traceback or "")):
        return int(frames[-1])
    defined = re.compile(rf"""^[\s"]*def\s+{re.escape(check.task)}\s*\(""", re.MULTILINE)
    # The last definition of a name is the one that counts.
    found = [match.end() for match in defined.finditer(text)]
    return text.count("\n", 0, found[-1]) + 1 if found else 1


def _path(here: Here, work: StudentWork, form: str) -> str:
    """A path relative to the folder of the lines' reader, with slashes on every system."""
    path = here.workspace.path(work.exercise.place, work.name)
    top = os.environ.get("GITHUB_WORKSPACE") if form == "github" else None
    try:
        return path.resolve().relative_to(Path(top).resolve() if top else cwd().resolve()).as_posix()
    except ValueError:
        return path.as_posix()

"""The instructor's two plain exports: ``results.jsonl`` with everything, ``grades.csv`` with the scores."""

import contextlib
import csv
import io
import os
import re
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

import msgspec

from course.catalog.models import CourseRef
from course.errors import MissingCapabilityError, UsageError
from course.grading.results.effective import NOT_YET, Effective, Results
from course.printable import one_line
from course.scoring.verdict import CheckResult, Problem, finite

# ---
# Text for cells, XML and files: a student's text, or a name, is shown and never interpreted.


#: A spreadsheet takes a cell that begins with one of these for a formula; with a full-width one in some
#: languages. The apostrophe that disarms them is itself doubled, so that no two texts become one.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "'", "\uff1d", "\uff0b", "\uff0d", "\uff20")
#: Points below zero, as a teacher takes them off: a number and no formula.
_NEGATIVE = re.compile(r"-[0-9]+([.,][0-9]+)?")

#: ``-o -``: to standard output.
STDOUT = Path("-")

#: How every SQLite file begins.
_DATABASE = b"SQLite format 3\0"


def safe_cell(text: str) -> str:
    """A cell that a spreadsheet shows as it is: formulas are disarmed, control characters are escaped."""
    shown = one_line(text)
    if _NEGATIVE.fullmatch(text):
        return shown
    return "'" + shown if text.lstrip().startswith(_FORMULA) or text.startswith(_FORMULA) else shown


def is_safe(text: str) -> bool:
    """Whether ``safe_cell`` leaves it unchanged, so that another program finds this exact key in the cell."""
    return safe_cell(text) == text


def for_moodle(text: str) -> str:
    """A cell that Moodle reads as it is: to PHP, a quote behind a backslash does not end a cell."""
    return re.sub(r'\\(?="|\Z)', r"\\ ", text)


def number(value: float | None) -> str:
    """Points, to a ten-thousandth and without zeros at the end; empty for None."""
    if value is None:
        return ""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def csv_bytes(headings: Sequence[str], rows: Iterable[Sequence[str]], *, mark: bool = True) -> bytes:
    """A table with every cell quoted and safe.

    Args:
        mark: put a byte order mark in front, which makes Excel read UTF-8; not every program knows it.
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text, quoting=csv.QUOTE_ALL, lineterminator="\r\n")
    writer.writerow([safe_cell(cell) for cell in headings])
    writer.writerows([safe_cell(cell) for cell in row] for row in rows)
    return b"\xef\xbb\xbf" * mark + text.getvalue().encode("utf-8")


def write_bytes(path: Path, content: bytes) -> None:
    """Write a whole file or none."""
    with replacing(path) as handle:
        handle.write(content)


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[IO[bytes]]:
    """A file that takes its name when it is complete; until then the old one stays.

    Raises:
        UsageError: it is a folder, or a database: a gradebook, most likely.
        MissingCapabilityError: there is no room, or it cannot be written there.
    """
    draft = None
    try:
        if path.is_dir():
            raise UsageError(f"{path} is a folder.", help="Name a file in it with -o.", code="bad_file_name")
        if path == STDOUT or (path.exists() and not path.is_file()):
            # A pipe or a device has nothing to keep and no second name; its reader may leave when it has
            # enough.
            whole = io.BytesIO()
            yield whole
            with contextlib.suppress(BrokenPipeError):
                sys.stdout.flush()
                target = os.dup(1) if path == STDOUT else os.open(path, os.O_WRONLY)
                with os.fdopen(target, "wb") as handle:
                    handle.write(whole.getvalue())
            return
        with contextlib.suppress(OSError), path.open("rb") as handle:
            if handle.read(len(_DATABASE)) == _DATABASE:
                message = f"{path} is a database, most likely a gradebook; it was not changed."
                raise UsageError(message, help="Name another file with -o.", code="is_a_database")
        path.parent.mkdir(parents=True, exist_ok=True)
        draft = path.with_name(f".{path.name}.{os.getpid()}")
        with draft.open("wb") as handle:
            yield handle
        draft.replace(path)
    except OSError as error:
        raise MissingCapabilityError(
            f"{'Standard output' if path == STDOUT else path} cannot be written: {error.strerror or error}.",
            help="Make room, or name another place with -o; the gradebook is complete.",
            code="cannot_write",
        ) from None
    finally:
        if draft is not None:
            with contextlib.suppress(OSError):
                draft.unlink(missing_ok=True)


#: The columns of ``grades.csv``: each heading, and what stands below it.
_COLUMNS: dict[str, Callable[[Effective], str]] = {
    "student": lambda one: one.student,
    "exercise": lambda one: one.exercise,
    "score": lambda one: number(one.score),
    "max_score": lambda one: number(one.max_score),
    "passed": lambda one: "yes" if one.passed else "no",
    "state": lambda one: one.verdict.state,
    "reason": lambda one: one.verdict.error.code if one.verdict.error else "",
    "late_s": lambda one: "" if one.late is None else f"{one.late:.0f}",
    "isolation": lambda one: one.verdict.isolation,
    "raw_score": lambda one: number(one.raw_score),
    "late_penalty": lambda one: number(one.penalty),
    "override_reason": lambda one: one.override.reason if one.override else "",
    "submitted_at": lambda one: utc(one.submitted_at),
    "graded_at": lambda one: one.result.graded_at,
}
#: The columns that a roster adds.
_PERSON = ("name", "email", "section")


class OverrideLine(msgspec.Struct, frozen=True):
    score: float
    reason: str
    at: str


class GradeLine(msgspec.Struct, frozen=True, kw_only=True, tag="course.grade/1", tag_field="schema"):
    """One student and exercise: the body of ``course.check/1`` and the fields that a grading run adds.

    ``score`` counts, ``raw_score`` is the checks' sum; both are null after a fault of the grader's.
    """

    ok: bool
    exit_code: int
    course: CourseRef
    student: str
    exercise: str
    scope: str
    state: str
    score: float | None
    max_score: float
    passed: bool
    checks: tuple[CheckResult, ...]
    error: Problem | None = None
    submission_sha256: str
    grader_version: str
    seed: int
    isolation: str
    late: float | None = None
    graded_at: str = ""
    warnings: tuple[str, ...] = ()
    raw_score: float | None = None
    late_penalty: float = 0.0
    override: OverrideLine | None = None
    submitted_at: str | None = None


def grade_line(effective: Effective, course: CourseRef) -> GradeLine:
    """A result as its line of JSON."""
    verdict, override = effective.verdict, effective.override
    codes = {"ungradable": 3, "grader_error": 70, NOT_YET: 3}
    by_hand = override is not None and override.score is not None
    judged = ("scope", "state", "checks", "error", "isolation", "warnings")
    counts = ("score", "max_score", "passed", "late", "raw_score")
    told: dict[str, Any] = asdict(effective.result.key)
    told |= {name: getattr(verdict, name) for name in judged}
    told |= {name: getattr(effective, name) for name in counts}
    return GradeLine(
        ok=verdict.all_pass,
        exit_code=codes.get(verdict.state, 0 if verdict.all_pass else 1),
        course=course,
        graded_at=effective.result.graded_at,
        late_penalty=effective.penalty,
        override=msgspec.convert(override, OverrideLine, from_attributes=True) if by_hand else None,
        submitted_at=utc(effective.submitted_at) or None,
        **told,
    )


def utc(seconds: float | None) -> str:
    """A time as ISO 8601; empty for None."""
    return "" if seconds is None else time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds))


def write_jsonl(path: Path, results: Iterable[Effective], course: CourseRef) -> None:
    """One line per student and exercise, with everything: for the instructor only."""
    with replacing(path) as handle:
        for effective in results:
            line = grade_line(effective, course)
            handle.write(msgspec.json.encode(finite(msgspec.to_builtins(line))) + b"\n")


def write_csv(path: Path, results: Results, chosen: Iterable[Effective]) -> None:
    """One row per student and exercise; every cell quoted, none of them a formula."""
    about = _PERSON if results.roster else ()
    rows = []
    for effective in chosen:
        person = results.person(effective.student)
        cells = [str(getattr(person, name)) if person else "" for name in about]
        rows.append([*(column(effective) for column in _COLUMNS.values()), *cells])
    write_bytes(path, csv_bytes((*_COLUMNS, *about), rows))

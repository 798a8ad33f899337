"""The instructor's own list of submission times: CSV with student, exercise and submitted_at."""

from __future__ import annotations

import csv
import datetime as dt
import io
from typing import TYPE_CHECKING

from course.errors import UsageError
from course.grading.gradebook.records import SubmittedAt

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["read_times"]

_COLUMNS = {"student", "exercise", "submitted_at"}


def read_times(path: Path) -> list[SubmittedAt]:
    """Read such a list; of several rows for the same work the last one counts.

    Raises:
        UsageError: it cannot be read or is not such a list; the message names the line.
    """
    try:
        text = path.read_text("utf-8-sig")
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8"
        raise _wrong(path, f"it cannot be read ({reason})") from None
    reader = csv.DictReader(io.StringIO(text, newline=""), strict=True)
    found: list[SubmittedAt] = []
    try:
        if not set(reader.fieldnames or ()) >= _COLUMNS:
            raise _wrong(path, "its first row lacks student, exercise or submitted_at")
        for row in reader:
            if not row["student"] or not row["exercise"]:
                raise _wrong(path, f"line {reader.line_num}: it names no student or no exercise")
            at = _seconds(path, reader.line_num, row["submitted_at"] or "")
            found.append(SubmittedAt(row["student"], row["exercise"], "", "list", at))
    except csv.Error as error:
        raise _wrong(path, f"line {reader.line_num}: {error}") from None
    return found


def _seconds(path: Path, line: int, text: str) -> float:
    try:
        time = dt.datetime.fromisoformat(text.strip())
    except ValueError:
        raise _wrong(path, f"line {line}: {text!r} is not a time") from None
    if time.tzinfo is None:
        raise _wrong(path, f"line {line}: {text!r} lacks its distance from UTC, as in +01:00")
    return time.timestamp()


def _wrong(path: Path, why: str) -> UsageError:
    return UsageError(
        f"{path}: {why}.",
        help="It is a CSV file: student, exercise, submitted_at, as in 2026-12-01T23:59:00+01:00.",
        code="invalid_times",
    )

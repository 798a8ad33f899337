"""The instructor's own list of submission times: CSV with student, exercise and submitted_at.

Moodle's grading worksheet is one, too. It has "Last modified (submission)" in words and without a time zone,
so it is read in the zone of the deadline, and it names no exercise.
"""

from __future__ import annotations

import csv
import datetime as dt
import io
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.errors import UsageError
from course.grading.gradebook.records import SubmittedAt
from course.grading.results.roster import decoded, in_english, moodle_key

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

__all__ = ["Worksheet", "read_times", "worksheet_times"]

_COLUMNS = {"student", "exercise", "submitted_at"}
_IDENTIFIER, _SUBMITTED = "Identifier", "Last modified (submission)"
#: The first three letters of the months, in English and in German.
_MONTHS = [
    ("jan",), ("feb",), ("mar", "mär"), ("apr",), ("may", "mai"), ("jun",), ("jul",), ("aug",), ("sep",),
    ("oct", "okt"), ("nov",), ("dec", "dez"),
]  # fmt: skip
#: "Tuesday, 1 December 2026, 11:59 PM", "Dienstag, 1. Dezember 2026, 23:59", "Tuesday, December 1, ...".
_WORDS = re.compile(
    r"(?:\w+, )?(?:(?P<day>\d{1,2})\.? (?P<month>\w+)|(?P<us_month>\w+) (?P<us_day>\d{1,2}),?)"
    r" (?P<year>\d{4}),? (?P<hour>\d{1,2}):(?P<minute>\d\d)(?::\d\d)?(?: (?P<half>[AaPp])\.?[Mm]\.?)?"
)


@dataclass(frozen=True)
class Worksheet:
    """Moodle's worksheet: when each participant's number last changed the submission, in words."""

    path: Path
    times: dict[str, str]


def read_times(path: Path) -> list[SubmittedAt] | Worksheet:
    """Read such a list, or a worksheet of Moodle's; of several rows for the same work the last one counts.

    Raises:
        UsageError: it cannot be read or is not such a list; the message names the line.
    """
    try:
        text = decoded(path.read_bytes())
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not text"
        raise _wrong(path, f"it cannot be read ({reason})") from None
    reader = csv.DictReader(io.StringIO(text, newline=""), strict=True)
    found: list[SubmittedAt] = []
    try:
        reader.fieldnames = in_english([str(name).strip() for name in reader.fieldnames or ()])
        if {_IDENTIFIER, _SUBMITTED} <= set(reader.fieldnames):
            cells = ((moodle_key(row[_IDENTIFIER] or ""), (row[_SUBMITTED] or "").strip()) for row in reader)
            return Worksheet(path, {key: words for key, words in cells if key and words.strip("-")})
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


def worksheet_times(
    sheet: Worksheet, students: Mapping[str, str], exercise: str, zone: dt.tzinfo
) -> list[SubmittedAt]:
    """The times of a worksheet.

    Args:
        students: participant's number -> student.
        zone: that of the deadline: Moodle writes none.

    Raises:
        UsageError: a time cannot be read.
    """
    found = []
    for key, words in sheet.times.items():
        if key in students:
            at = _in_words(sheet.path, words).replace(tzinfo=zone).timestamp()
            found.append(SubmittedAt(students[key], exercise, "", "list", at))
    return found


def _in_words(path: Path, words: str) -> dt.datetime:
    found = _WORDS.fullmatch(words)
    name = ((found["month"] or found["us_month"]) if found else "")[:3].casefold()
    month = next((number for number, names in enumerate(_MONTHS, 1) if name in names), 0)
    try:
        if found is None or not month:
            raise ValueError
        hour = int(found["hour"])
        if found["half"]:
            hour = hour % 12 + 12 * (found["half"] in "Pp")
        day = int(found["day"] or found["us_day"])
        return dt.datetime(int(found["year"]), month, day, hour, int(found["minute"]))
    except ValueError:
        raise _wrong(path, f"{words!r} is not a time as Moodle writes one in English or German") from None


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

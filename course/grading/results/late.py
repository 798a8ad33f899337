"""The cost of lateness: a policy as data, applied when scores are read and never written into them.

docs/instructor.md shows one whole.

Which time counts: a student's clock is never trusted, so no time inside a submission is read. The
instructor's own list and a learning platform's download are trusted; the time of a file is trusted only where
the policy says so, because copying and unpacking change it.
"""

from __future__ import annotations

import contextlib
import datetime as dt
import math
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import msgspec

from course.catalog.reading import Document, read_document
from course.errors import ContentError, MissingCapabilityError, UsageError
from course.grading.gradebook.records import SubmittedAt
from course.grading.results.roster import moodle_key, read_table, spelled
from course.strangers import read_bytes, toml

FORMAT_VERSION = 1
_DAY_S = 86_400.0
#: A timestamp may be stored to the second: arriving in the second of the deadline is in time.
_ROUNDING_S = 1.0
#: Seconds since 1970 that are a date in every zone.
_FAR_OFF = 2e11

_Share = Annotated[float, msgspec.Meta(ge=0, le=100)]
_Days = Annotated[float, msgspec.Meta(ge=0, le=3660)]
Source = Literal["list", "gradescope", "mtime"]


class Deadline(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """When an exercise is due; the time must have an offset from UTC."""

    exercise: str
    due: dt.datetime


class Extension(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """More time for one student."""

    student: str
    days: _Days
    exercise: str = "*"


class Policy(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A late policy; the fields are those of the file."""

    format_version: int
    deadline: tuple[Deadline, ...]
    extension: tuple[Extension, ...] = ()
    grace_minutes: Annotated[float, msgspec.Meta(ge=0, le=10_080)] = 0.0
    percent_per_day: _Share = 0.0
    points_per_day: Annotated[float, msgspec.Meta(ge=0)] = 0.0
    of: Literal["maximum", "score"] = "maximum"
    at_most_percent: _Share = 100.0
    closed_after_days: _Days | None = None
    trust: tuple[Source, ...] = ("list", "gradescope")
    zone: str = ""

    def due(self, exercise: str, student_names: tuple[str, ...], granted_days: float = 0.0) -> float | None:
        """When it is due for this student, in seconds since 1970; None if the policy does not say.

        Args:
            student_names: every id the student goes by.
            granted_days: more time from elsewhere (the roster); the longest extension counts.
        """
        exact = [item for item in self.deadline if item.exercise == exercise]
        found = exact or [item for item in self.deadline if item.exercise == "*"]
        if not found:
            return None
        names = {*map(spelled, student_names)}
        mine = (item for item in self.extension if spelled(item.student) in names)
        days = (item.days for item in mine if item.exercise in {"*", exercise})
        first = found[0].due.timestamp()
        last = first + _DAY_S * max([granted_days, *days])
        return last - self._forward(first, last)

    def penalty(self, late_s: float | None, score: float, maximum: float, due: float = 0.0) -> float:
        """The penalty for being late by so many seconds after it was due, in points."""
        if late_s is None or late_s <= 60.0 * self.grace_minutes:
            return 0.0
        by_clock = max(late_s + self._forward(due, due + late_s), _ROUNDING_S)
        if self.closed_after_days is not None and by_clock > self.closed_after_days * _DAY_S:
            return score
        days = math.ceil(by_clock / _DAY_S)
        base = maximum if self.of == "maximum" else score
        points = days * (self.percent_per_day / 100.0 * base + self.points_per_day)
        return min(points, self.at_most_percent / 100.0 * base, score)

    def _forward(self, first: float, last: float) -> float:
        """Seconds that the zone's clock was put forward between two times; 0 without a zone."""
        if not self.zone:
            return 0.0
        within = (min(max(at, 0.0), _FAR_OFF) for at in (first, last))
        was, now = (dt.datetime.fromtimestamp(at, ZoneInfo(self.zone)).utcoffset() for at in within)
        return (now - was).total_seconds() if now is not None and was is not None else 0.0


def lateness(submitted: float, due: float) -> float | None:
    """Seconds after the deadline; None if in time."""
    late = submitted - due
    return late if late >= _ROUNDING_S else None


def may_change(first: float, last: float) -> bool:
    """Whether summer time may begin or end between: on a Sunday of these months, wherever it does."""
    within = (min(max(at, 0.0), _FAR_OFF) for at in sorted((first, last)))
    start, end = (dt.datetime.fromtimestamp(at, dt.UTC).date() for at in within)
    days = (start + dt.timedelta(days=after) for after in range(min((end - start).days, 366) + 1))
    return any(day.weekday() == 6 and day.month in {3, 4, 9, 10, 11} for day in days)


def read_policy(path: Path) -> tuple[Policy, str]:
    """A policy, and its text for the gradebook.

    Raises:
        UsageError: the file cannot be read, or is not a policy.
        MissingCapabilityError: it is in a newer format.
    """
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8"
        raise UsageError(f"{path} cannot be read: {reason}.", help="Name a late policy.") from None
    return parse_policy(text, str(path)), text


def parse_policy(text: str, name: str = "The late policy") -> Policy:
    """A policy from its text.

    Raises:
        UsageError: it is not a policy; the message names the place.
        MissingCapabilityError: it is in a newer format.
    """
    with contextlib.suppress(tomllib.TOMLDecodeError):
        version = toml(text).get("format_version")
        if isinstance(version, int) and version > FORMAT_VERSION:
            message = f"{name} is in a newer format ({version})."
            raise MissingCapabilityError(message, help="Update the course.", code="newer_format")
    try:
        document = read_document(Path(name), Policy, text=text)
        _check(document)
    except ContentError as error:
        advice = f"{error.help} docs/instructor.md shows a whole policy."
        raise UsageError(error.message, help=advice, code="invalid_policy") from None
    return document.value


def _check(document: Document[Policy]) -> None:
    policy = document.value
    try:
        ZoneInfo(policy.zone or "UTC")
    except (ZoneInfoNotFoundError, ValueError, OSError):
        fix = 'Write one as in "Europe/Berlin"; a system without a list of them needs `pip install tzdata`.'
        document.fail(("zone",), f"{policy.zone!r} is no time zone that is known here.", fix=fix)
    exercises: set[str] = set()
    for index, deadline in enumerate(policy.deadline):
        if deadline.due.tzinfo is None:
            fix = f"Write {deadline.due.isoformat()}+01:00."
            document.fail(("deadline", index, "due"), "this time lacks its distance from UTC.", fix=fix)
        if deadline.exercise in exercises:
            problem = f"{deadline.exercise} has two deadlines."
            document.fail(("deadline", index, "exercise"), problem, fix="Keep one.")
        exercises.add(deadline.exercise)
    if policy.percent_per_day and policy.points_per_day:
        document.fail(("points_per_day",), "there is percent_per_day, too.", fix="Keep one of them.")


def unknown_names(policy: Policy, exercises: Mapping[str, object], students: set[str]) -> list[str]:
    """Exercises and students in the policy that were not graded: typing errors, most likely."""
    named = {item.exercise for item in policy.deadline} | {item.exercise for item in policy.extension}
    named.discard("*")
    unknown = [f"exercise {name}" for name in sorted(named - exercises.keys())]
    there = {*map(spelled, students)}
    names = {item.student for item in policy.extension if spelled(item.student) not in there}
    return unknown + [f"student {name}" for name in sorted(names)]


def in_days(seconds: float) -> str:
    """A lateness in words, in minutes begun: what is over a limit shows as more than it."""
    days, rest = divmod(math.ceil(seconds / 60), 1440)
    hours, minutes = divmod(rest, 60)
    parts = [f"{days} d"] * bool(days) + [f"{hours} h"] * bool(hours) + [f"{minutes} min"] * bool(minutes)
    return " ".join(parts) or "0 min"


# ---
# The instructor's own list of submission times: CSV with student, exercise and submitted_at.
#
# Moodle's grading worksheet is one, too. It has "Last modified (submission)" in words and without a time
# zone, so it is read in the zone of the deadline, and it names no exercise.


_COLUMNS = {"student", "exercise", "submitted_at"}
_IDENTIFIER, _SUBMITTED = "Identifier", "Last modified (submission)"
_YEAR = re.compile(r"\b20[0-9]{2}\b")
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
    """Moodle's worksheet: when each participant's number last changed the submission, in words; and whose
    row says that Moodle gave more time."""

    path: Path
    times: dict[str, str]
    extended: frozenset[str]

    def at(self, key: str, zone: dt.tzinfo) -> float:
        """When a participant handed in, in seconds since 1970, by the clock of a zone: Moodle writes none.

        Raises:
            UsageError: the time cannot be read.
        """
        return _in_words(self.path, self.times[key]).replace(tzinfo=zone).timestamp()


def read_times(path: Path) -> list[SubmittedAt] | Worksheet:
    """Read such a list, or a worksheet of Moodle's.

    Raises:
        UsageError: it cannot be read, is not such a list, or has two times for the same work; the message
            names the line.
    """
    _, headings, rows = read_table(path, _wrong_times)
    lines: dict[tuple[str, ...], int] = {}
    if {_IDENTIFIER, _SUBMITTED} <= {*headings}:
        times, extended = {}, set[str]()
        for line, row in rows:
            key, words = moodle_key(row[_IDENTIFIER] or ""), (row[_SUBMITTED] or "").strip()
            if key and words.strip("-"):
                _once(path, lines, line, key)
                times[key] = words
                # In any language: of what stands there, an extension alone has a date.
                extended |= {key} if _YEAR.search(row.get("Status") or "") else set()
        return Worksheet(path, times, frozenset(extended))
    if not {*headings} >= _COLUMNS:
        raise _wrong_times(path, "its first row lacks student, exercise or submitted_at")
    found = []
    for line, row in rows:
        if not row["student"] or not row["exercise"]:
            raise _wrong_times(path, f"line {line}: it names no student or no exercise")
        _once(path, lines, line, row["student"], row["exercise"])
        at = _seconds(path, line, row["submitted_at"] or "")
        found.append(SubmittedAt(row["student"], row["exercise"], "", "list", at))
    return found


def _once(path: Path, lines: dict[tuple[str, ...], int], line: int, *work: str) -> None:
    """Refuse a second time for the same work: nobody said which counts."""
    if (first := lines.setdefault(work, line)) != line:
        named = " ".join(map(repr, work))
        raise _wrong_times(path, f"{named} is in two rows, on lines {first} and {line}")


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
        why = f"{words!r} is not a time as Moodle writes one in English or German"
        raise _wrong_times(path, why) from None


def _seconds(path: Path, line: int, text: str) -> float:
    try:
        time = dt.datetime.fromisoformat(text.strip())
    except ValueError:
        raise _wrong_times(path, f"line {line}: {text!r} is not a time") from None
    if time.tzinfo is None:
        raise _wrong_times(path, f"line {line}: {text!r} lacks its distance from UTC, as in +01:00")
    return time.timestamp()


def _wrong_times(path: Path, why: str) -> UsageError:
    advice = "It is a CSV file: student, exercise, submitted_at, as in 2026-12-01T23:59:00+01:00."
    return UsageError(f"{path}: {why}.", help=advice, code="invalid_times")

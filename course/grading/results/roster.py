"""Who is in the class, as the learning platform knows them: the link between folders and its ids.

A roster is a CSV file with a heading row. ``student`` is the name of the folder a student's work is graded
from; the other columns are optional: name, email, canvas_id, sis_user_id, section, moodle_key,
extension_days. A student is found by ``student``, or, for a class downloaded from a platform, by that
platform's own number. A name is used only where no number can be (Moodle's downloads carry a number of their
own), and only if one student alone has it; who cannot be told apart is listed.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from course.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from course.grading.gradebook.book import FromDownload

__all__ = ["COLUMNS", "Person", "Roster", "read_roster"]

COLUMNS = (
    "student", "name", "email", "canvas_id", "sis_user_id", "section", "moodle_key", "extension_days",
)  # fmt: skip
_MAX_BYTES = 20 << 20


class Person(msgspec.Struct, frozen=True):
    """One row of a roster."""

    student: str
    name: str = ""
    email: str = ""
    canvas_id: str = ""
    sis_user_id: str = ""
    section: str = ""
    moodle_key: str = ""
    extension_days: float = 0.0


@dataclass
class Roster:
    """A class list.

    Attributes:
        people: the rows, in the order of the file.
    """

    people: tuple[Person, ...]
    _by: dict[tuple[str, str], list[Person]] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        for person in self.people:
            for kind, value in (
                ("student", person.student),
                ("canvas", person.canvas_id),
                ("moodle", person.moodle_key),
                ("email", person.email.casefold()),
                ("sid", person.sis_user_id),
                ("name", _folded(person.name)),
            ):
                if value:
                    self._by.setdefault((kind, value), []).append(person)

    def find(self, student: str, download: FromDownload | None = None) -> Person | None:
        """The one row about a student of the gradebook; None if there is none, or more than one."""
        for kind, value in _keys(student, download):
            found = self._by.get((kind, value), []) if value else []
            if found:
                return found[0] if len(found) == 1 else None
        return None

    def match(
        self, students: Iterable[str], downloads: Mapping[str, FromDownload]
    ) -> tuple[dict[str, Person], list[str]]:
        """Rows for students of a gradebook, and the students without exactly one of their own."""
        found: dict[str, Person] = {}
        unmatched: list[str] = []
        for student in students:
            person = self.find(student, downloads.get(student))
            if person is None:
                unmatched.append(student)
            else:
                found[student] = person
        claims: dict[str, list[str]] = {}
        for student, person in found.items():
            claims.setdefault(person.student, []).append(student)
        for claimants in claims.values():
            if len(claimants) > 1:  # two folders, one row: which of them counts is not ours to guess
                unmatched += claimants
                for student in claimants:
                    del found[student]
        return found, sorted(unmatched)

    def dump(self) -> str:
        """The roster as a gradebook keeps it."""
        return msgspec.json.encode(self.people).decode()

    @classmethod
    def load(cls, text: str) -> Roster:
        """A roster as ``dump`` gave it."""
        return cls(msgspec.json.decode(text, type=tuple[Person, ...]))


def _keys(student: str, download: FromDownload | None) -> list[tuple[str, str]]:
    keys = [("student", student)]
    if download is not None and download.source == "canvas":
        keys += [("canvas", download.key)]
    if download is not None and download.source == "gradescope":
        keys += [("sid", download.sid), ("student", download.sid), ("email", download.email.casefold())]
    if download is not None and download.source == "moodle":
        keys += [("moodle", download.key), ("name", _folded(download.name))]
    return keys


def _folded(name: str) -> str:
    """A name for comparison: one spelling of accents, letter case and spaces."""
    return " ".join(unicodedata.normalize("NFKC", name).casefold().split())


def read_roster(path: Path) -> Roster:
    """Read a roster.

    Raises:
        UsageError: it cannot be read or is no roster; the message names the row.
    """
    try:
        raw = path.read_bytes()
        if len(raw) > _MAX_BYTES:
            raise _wrong(path, "it is larger than 20 MB")
        text = raw.decode("utf-8-sig")
    except OSError as error:
        raise _wrong(path, f"it cannot be read ({error.strerror})") from None
    except UnicodeError:
        raise _wrong(path, "it is not UTF-8; save it as 'CSV UTF-8'") from None
    reader = csv.DictReader(io.StringIO(text, newline=""), strict=True)
    try:
        headings = [str(name).strip() for name in reader.fieldnames or ()]
        reader.fieldnames = headings
        _check_headings(path, headings)
        people = tuple(_person(path, reader.line_num, row) for row in reader if any(row.values()))
    except csv.Error as error:
        raise _wrong(path, f"line {reader.line_num}: {error}") from None
    _check_unique(path, people)
    return Roster(people)


def _check_headings(path: Path, headings: list[str]) -> None:
    if "student" not in headings:
        raise _wrong(path, "its first row has no heading 'student'")
    if len(set(headings)) < len(headings):
        raise _wrong(path, "two columns have one heading")
    unknown = sorted(set(headings) - set(COLUMNS))
    if unknown:
        raise _wrong(path, f"the heading {unknown[0]!r} is not one of {', '.join(COLUMNS)}")


def _person(path: Path, line: int, row: dict[str, str | None]) -> Person:
    if None in row or None in row.values():
        raise _wrong(path, f"line {line}: it has another number of cells than the headings")
    # A student's id is the name of a folder, spaces and all; the rest was typed by somebody.
    cells = {name: (text or "") if name == "student" else (text or "").strip() for name, text in row.items()}
    if not cells["student"]:
        raise _wrong(path, f"line {line}: it names no student")
    if cells.get("canvas_id") and not re.fullmatch(r"[0-9]{1,20}", cells["canvas_id"]):
        raise _wrong(path, f"line {line}: canvas_id {cells['canvas_id']!r} is not a number")
    days = cells.pop("extension_days", "") or "0"
    try:
        granted = float(days)
    except ValueError:
        granted = -1.0
    if not 0 <= granted <= 3660:
        raise _wrong(path, f"line {line}: extension_days is {days!r}, not a number of days")
    return Person(**cells, extension_days=granted)


def _check_unique(path: Path, people: tuple[Person, ...]) -> None:
    for column in ("student", "canvas_id", "sis_user_id", "moodle_key"):
        seen: set[str] = set()
        for person in people:
            value = getattr(person, column)
            if value and value in seen:
                raise _wrong(path, f"{column} {value!r} is in two rows")
            seen.add(value)


def _wrong(path: Path, why: str) -> UsageError:
    return UsageError(
        f"{path}: {why}.",
        help=f"A roster is a CSV file with the columns {', '.join(COLUMNS)}; all but the first are optional.",
        code="invalid_roster",
    )

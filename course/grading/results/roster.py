"""Who is in the class: a roster links a student's folder to the ids of a learning platform.

A roster is a CSV file with a heading row, of one of four kinds, known by the headings:

    our own             student (the name of the folder a student's work is graded from), and as far as they
                        are needed name, email, canvas_id, sis_user_id, section, moodle_key, extension_days
    Canvas' gradebook   Student, or LastName and FirstName; ID, SIS User ID, SIS Login ID, Section, then its
                        assignments
    Moodle's worksheet  Identifier, Full name, Email address, ... as "Download grading worksheet" gives it;
                        names and addresses are not in it where Moodle grades anonymously
    Gradescope's        First Name and Last Name, or Name; SID, Email, and Role if there is one

A student is found by ``student``, or, for a class downloaded from a platform, by that platform's own number.
A name is used only where there is no number, and only if one student alone has it. A plain folder may be
called after any of a student's ids, login, address or name, if that is in one row alone. Ambiguous students
are listed.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from course.errors import UsageError
from course.grading.gradebook.records import PlatformIdentity
from course.printable import one_line, some
from course.strangers import decoded, read_bytes

COLUMNS = (
    "student", "name", "email", "login", "canvas_id", "sis_user_id", "section", "moodle_key",
    "extension_days",
)  # fmt: skip
#: The columns that a plain folder may be called after, and where each of a download's keys is looked for.
_FOLDER = ("student", "canvas_id", "sis_user_id", "login", "moodle_key", "email", "name")
_DOWNLOAD = {
    "canvas": ("canvas_id",),
    "gradescope": ("sis_user_id", "student", "email"),
    "moodle": ("moodle_key", "name"),
}
#: The headings of the platforms' files, by our column.
_CANVAS = {"name": "Student", "canvas_id": "ID", "sis_user_id": "SIS User ID", "login": "SIS Login ID"}
_MOODLE = {
    "moodle_key": "Identifier", "name": "Full name", "email": "Email address",
    "sis_user_id": "ID number", "login": "Username",
}  # fmt: skip
#: Moodle's worksheet in German, known by one of the headings that nothing else has.
_GERMAN_SIGNS = {"vollständiger name", "zuletzt geändert (abgabe)", "zuletzt geändert (bewertung)"}
_GERMAN = {
    "ID": "Identifier", "Vollständiger Name": "Full name", "E-Mail-Adresse": "Email address",
    "ID-Nummer": "ID number", "Anmeldename": "Username", "Bewertung": "Grade", "Bestwertung": "Maximum Grade",
    "Bewertung kann geändert werden": "Grade can be changed",
    "Zuletzt geändert (Abgabe)": "Last modified (submission)",
    "Zuletzt geändert (Bewertung)": "Last modified (grade)", "Feedback als Kommentar": "Feedback comments",
}  # fmt: skip
_GRADESCOPE = {"sis_user_id": "SID", "email": "Email", "name": "Name"}
#: The platforms' headings by their small letters: Moodle's versions write "Maximum Grade" or "Maximum grade".
_SPELLED = {
    name.casefold(): name
    for name in (
        *_CANVAS.values(), "LastName", "FirstName", "Section", *_GERMAN.values(), *_GRADESCOPE.values(),
        "First Name", "Last Name", "Role", "Sections",
    )
    if name != "Student"  # in small letters it is a roster of our own
}  # fmt: skip
_GERMAN_SPELLED = {german.casefold(): english for german, english in _GERMAN.items()}
#: Canvas' own student, with whom a teacher tries an assignment: "Student, Test" in its gradebook.
_TEST_STUDENT = re.compile(r"studenttest(_[0-9]+)?")
FOR_TESTS = "Canvas' student for tests"
#: Points as Canvas writes them, in the language of whoever exports: 10.00 or 10,00, thousands not parted.
_POINTS = re.compile(r"[0-9]{1,9}([.,][0-9]{1,9})?")
#: Columns of a file that are named: a Canvas gradebook has one for each assignment.
_NAMED = 8


#: A student's id without the spaces around it.
_TRIMMED = "student, trimmed"


class Person(msgspec.Struct, frozen=True, omit_defaults=True):
    """One row of a roster; ``extension_days`` is None where it says nothing about them."""

    student: str
    name: str = ""
    email: str = ""
    canvas_id: str = ""
    sis_user_id: str = ""
    section: str = ""
    moodle_key: str = ""
    extension_days: float | None = None
    login: str = ""


@dataclass(frozen=True)
class Column:
    """An assignment's column in Canvas' gradebook: its heading, its points if the file says them, and what
    stands there, by the student's id."""

    heading: str
    points: float | None
    cells: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Roster:
    """A class list.

    Attributes:
        people: the rows, in the order of the file.
        file: where it was read; empty if it is the one in a gradebook.
        headings: of that file, as they stand there, if it is known.
        columns: the heading of each of our columns that it has, as it stands there.
        assignments: the columns of Canvas' gradebook, by the id of the assignment.
    """

    people: tuple[Person, ...]
    file: str = ""
    headings: tuple[str, ...] = ()
    columns: dict[str, str] = field(default_factory=dict)
    assignments: dict[str, Column] = field(default_factory=dict)
    _by: dict[tuple[str, str], list[Person]] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if not self.columns:
            known = (name for name in _FOLDER if any(getattr(row, name) for row in self.people))
            self.columns = {name: name for name in known}
        for person in self.people:
            keys = {(column, _key(column, getattr(person, column))) for column in _FOLDER}
            last, comma, first = person.name.partition(",")
            if comma:  # Canvas sorts by "Lovelace, Ada"
                keys.add(("name", _key("name", f"{first} {last}")))
            keys.add((_TRIMMED, _key("student", person.student).strip()))
            for key in keys:
                if key[1]:
                    self._by.setdefault(key, []).append(person)

    def find(self, student: str, download: PlatformIdentity | None = None) -> Person | None:
        """The one row about a student of the gradebook; None if there is none, or more than one."""
        found = self.rows(student, download)
        return found[0] if len(found) == 1 else None

    def rows(self, student: str, download: PlatformIdentity | None = None) -> list[Person]:
        """The rows that may be about a student of the gradebook."""
        key = _key("student", student)
        # A space at an end of a cell was typed, and is seen by nobody; a folder that has it comes first.
        if found := self._by.get(("student", key), []) or self._by.get((_TRIMMED, key.strip()), []):
            return found
        if download is None:
            rows = [row for name in _FOLDER for row in self._by.get((name, _key(name, student)), [])]
            return list(dict.fromkeys(rows))
        for column, value in _keys(download):
            if found := self._by.get((column, _key(column, value)), []):
                return found
        return []

    def having(self, column: str, value: str) -> list[Person]:
        """The rows with this value in a column; none for an empty one."""
        return self._by.get((column, _key(column, value)), [])

    def match(
        self, students: Iterable[str], downloads: Mapping[str, PlatformIdentity]
    ) -> tuple[dict[str, Person], dict[str, str]]:
        """Rows for students of a gradebook, and why others have none of their own, ordered by student."""
        found: dict[str, Person] = {}
        unmatched: dict[str, str] = {}
        for student in students:
            rows = self.rows(student, downloads.get(student))
            if _TEST_STUDENT.fullmatch(student):
                unmatched[student] = FOR_TESTS
            elif len(rows) == 1:
                found[student] = rows[0]
            else:
                unmatched[student] = f"In {len(rows)} rows" if rows else "In no row"
        claims: dict[str, list[str]] = {}
        for student, person in found.items():
            claims.setdefault(person.student, []).append(student)
        for claimants in claims.values():
            if len(claimants) > 1:  # two folders, one row: we must not guess which of them counts
                numbered = [one for one in claimants if not _by_name(one, downloads.get(one), found[one])]
                keeps = numbered[0] if len(numbered) == 1 else None  # a number is surer than a name
                for student in (one for one in claimants if one != keeps):
                    others = ", ".join(repr(other) for other in claimants if other != student)
                    unmatched[student] = f"In one row with {others}"
                    del found[student]
        return found, dict(sorted(unmatched.items()))

    @property
    def called(self) -> str:
        """The roster at the beginning of a sentence: its file, if that is known."""
        return self.file or "The roster in the gradebook"

    def compared(self, students: Iterable[str], downloads: Mapping[str, PlatformIdentity]) -> str:
        """The columns there are, and in which of them these students were looked for, as sentences."""
        headings = self.headings or tuple(self.columns.values())
        told = [f"{self.called} has the columns {some(headings, _NAMED)}."]
        sources = {downloads[name].source if name in downloads else "" for name in students}
        for source in sorted(sources):
            columns = _DOWNLOAD.get(source, _FOLDER)
            tried = ", ".join(self.columns[name] for name in columns if name in self.columns)
            what = f"The {source.capitalize()} id of a submission" if source else "The name of a folder"
            found = f"was looked for in {tried}; it has to be in exactly one row"
            told.append(f"{what} {found if tried else 'is in none of these'}.")
        return one_line(" ".join(told))

    def dump(self) -> str:
        return msgspec.json.encode(self.people).decode()

    @classmethod
    def load(cls, text: str) -> Roster:
        return cls(msgspec.json.decode(text, type=tuple[Person, ...]))


def _by_name(student: str, download: PlatformIdentity | None, person: Person) -> bool:
    """Whether nothing but a name says that a row is about this student of Moodle's."""
    moodle = download is not None and download.source == "moodle" and download.key != person.moodle_key
    return moodle and _key("student", student) != _key("student", person.student)


def _keys(download: PlatformIdentity) -> list[tuple[str, str]]:
    """The columns in which a download's student is looked for, the surest first, and what for."""
    if download.source == "gradescope":
        return list(zip(_DOWNLOAD["gradescope"], (download.sid, download.sid, download.email), strict=True))
    return list(zip(_DOWNLOAD.get(download.source, ()), (download.key, download.name), strict=False))


def _key(column: str, value: str) -> str:
    """A cell for comparison."""
    if column == "name":  # one spelling of accents, letter case and spaces
        return " ".join(unicodedata.normalize("NFKC", value).casefold().split())
    return value.casefold() if column in {"email", "login"} else spelled(value)


def spelled(name: str) -> str:
    """A name with its accents in one Unicode form, for comparison: macOS takes them apart."""
    return unicodedata.normalize("NFC", name)


def read_roster(path: Path) -> Roster:
    """Read a roster.

    Raises:
        UsageError: it cannot be read or is not a roster; the message names the row.
    """
    given, headings, table = read_table(path, _wrong)
    kind, columns = _kind(path, headings, given)
    # A row of blanks is none.
    rows = [
        _cells(path, line, row)
        for line, row in table
        if any(cell.strip() if isinstance(cell, str) else cell for cell in row.values())
    ]
    found = [(person, line) for row, line in rows if (person := kind(path, line, row)) is not None]
    _check_unique(path, found)
    people = tuple(person for person, _ in found)
    there = {name: given[headings.index(one)] for name, one in columns.items() if one in headings}
    assignments = _assignments(headings, [row for row, _ in rows]) if kind is _from_canvas else {}
    return Roster(people, one_line(path.name), tuple(given), there, assignments)


def read_table(
    path: Path, wrong: Callable[[Path, str], UsageError]
) -> tuple[list[str], list[str], list[tuple[int, dict[str, str | None]]]]:
    """The headings as they stand there and in English, and the rows by the latter, each with its line.

    Commas, semicolons or tabs part the cells, as whoever exports has it.

    Args:
        wrong: makes the error that is raised, from why the file is none that can be read.
    """
    text = read_text(path, wrong)
    reader = csv.DictReader(io.StringIO(text, newline=""), delimiter=delimiter_of(text), strict=True)
    try:
        given = [str(name).strip() for name in reader.fieldnames or ()]
        reader.fieldnames = headings = in_english(given)
        return given, headings, [(reader.line_num, row) for row in reader]
    except csv.Error as error:
        raise wrong(path, f"line {reader.line_num + 1}: {error}") from None


def delimiter_of(text: str) -> str:
    """What parts the cells of a table: it is the most frequent in the headings."""
    first = text.partition("\n")[0]
    return max(",;\t", key=first.count)


def read_text(path: Path, wrong: Callable[[Path, str], UsageError]) -> str:
    try:
        return decoded(read_bytes(path))
    except OSError as error:
        raise wrong(path, f"it cannot be read ({error.strerror})") from None
    except UnicodeError:
        raise wrong(path, "it is not text; save it as 'CSV UTF-8'") from None


def in_english(headings: list[str]) -> list[str]:
    """A platform's headings as they are here, whatever their letter case, and Moodle's worksheet in
    English; others unchanged."""
    stripped = [name.strip() for name in headings]
    lower = [name.casefold() for name in stripped]
    if "student" in lower and set(lower) <= set(COLUMNS):  # a roster of our own
        return lower
    if "student" in stripped:  # a list of our own
        return stripped
    known = _GERMAN_SPELLED if _in_german(stripped) else _SPELLED
    return [known.get(name.casefold(), name) for name in stripped]


def as_there(name: str, headings: Sequence[str]) -> str:
    """A heading of Moodle's worksheet in the language of these."""
    german = (theirs for theirs, ours in _GERMAN.items() if ours == name)
    return next(german, name) if _in_german(headings) else name


def _in_german(headings: Sequence[str]) -> bool:
    return not _GERMAN_SIGNS.isdisjoint(name.strip().casefold() for name in headings)


#: Turns a row into a person, or None if the row is not about a person.
Kind = Callable[[Path, int, dict[str, str]], "Person | None"]


def _kind(path: Path, headings: list[str], given: list[str]) -> tuple[Kind, dict[str, str]]:
    """The kind of roster that has these headings, and its headings by our column.

    Args:
        given: the headings as they stand there.
    """
    found = set(headings)
    if {"Identifier", "Full name"} <= found or {"Identifier", "Grade"} <= found:
        return _from_moodle, _MOODLE
    if {"Student", "ID"} <= found or {"LastName", "FirstName", "ID"} <= found:
        return _from_canvas, _CANVAS if "Student" in found else {**_CANVAS, "name": "LastName"}
    if {"First Name", "Last Name", "Email"} <= found or {"Name", "Email"} <= found:
        return _from_gradescope, _GRADESCOPE if "Name" in found else {**_GRADESCOPE, "name": "First Name"}
    if not any(headings):
        raise _wrong(path, "its first row is empty")
    if "student" not in found:
        listed = one_line(", ".join(given))
        why = f"its first row has no heading 'student', and {listed} are not those of a platform's file"
        raise _wrong(path, why)
    if len(found) < len(headings):
        raise _wrong(path, "two columns have one heading")
    unknown = sorted(found - set(COLUMNS))
    if unknown:
        raise _wrong(path, f"the heading {unknown[0]!r} is not one of {', '.join(COLUMNS)}")
    return _from_ours, {name: name for name in COLUMNS}


def _cells(path: Path, line: int, row: dict[str, str | None]) -> tuple[dict[str, str], int]:
    if None in row or None in row.values():
        raise _wrong(path, f"line {line}: it has another number of cells than the headings")
    # A student's id is the name of a folder, including spaces; the other cells were typed by hand.
    cells = ((name, text or "") for name, text in row.items())
    return {name: text if name == "student" else text.strip() for name, text in cells}, line


def _known(row: dict[str, str], columns: dict[str, str]) -> dict[str, Any]:
    """The cells of a platform's row by our columns; empty where its file has no such heading."""
    return {ours: row.get(heading, "") for ours, heading in columns.items()}


def _from_ours(path: Path, line: int, row: dict[str, str]) -> Person:
    cells = dict(row)
    if not cells["student"]:
        raise _wrong(path, f"line {line}: it names no student")
    if cells.get("canvas_id") and not re.fullmatch(r"[0-9]{1,20}", cells["canvas_id"]):
        raise _wrong(path, f"line {line}: canvas_id {cells['canvas_id']!r} is not a number")
    days = cells.pop("extension_days", "")
    try:
        granted = float(days) if days else None
    except ValueError:
        granted = -1.0
    if granted is not None and not 0 <= granted <= 3660:
        raise _wrong(path, f"line {line}: extension_days is {days!r}, not a number of days")
    return Person(**cells, extension_days=granted)


def _from_canvas(path: Path, line: int, row: dict[str, str]) -> Person | None:
    """A row of Canvas' gradebook; below its headings it has rows about columns, and a student for tests."""
    name = row.get("Student") or ", ".join(filter(None, (row.get("LastName"), row.get("FirstName"))))
    key = row["ID"]
    if not key:
        return None  # "Points Possible", "Manual Posting"
    if not re.fullmatch(r"[0-9]{1,20}", key):
        raise _wrong(path, f"line {line}: ID {key!r} is not a number")
    if name == "Student, Test":
        return None
    # As Canvas calls the files of a download: the sortable name without anything but letters and digits.
    plain = "".join(letter for letter in name.casefold() if letter.isalnum())
    known = _known(row, _CANVAS) | {"name": name}
    return Person(f"{plain}_{key}", section=row.get("Section", ""), **known)


def _assignments(headings: list[str], rows: list[dict[str, str]]) -> dict[str, Column]:
    """The assignments of Canvas' gradebook: "Title (id)", and their points in a row without an ID."""
    found = {}
    for heading in headings:
        if id_ := re.search(r"\(([0-9]+)\)$", heading):
            cells = [(row["ID"], row[heading]) for row in rows]
            most = (cell.replace(",", ".") for key, cell in cells if not key and _POINTS.fullmatch(cell))
            points = [float(cell) for cell in most]
            theirs = {key: cell for key, cell in cells if key and cell}
            found[id_[1]] = Column(heading, points[0] if points else None, theirs)
    return found


def _from_moodle(path: Path, line: int, row: dict[str, str]) -> Person:
    """A row of Moodle's grading worksheet; its files are called by name and the participant's number."""
    key = moodle_key(row["Identifier"])
    if key is None:
        raise _wrong(path, f"line {line}: Identifier {row['Identifier']!r} ends in no number")
    # Graded anonymously, a download calls its folders as the worksheet calls its rows.
    name = row.get("Full name", "").replace("_", "") or row["Identifier"].removesuffix(key).strip()
    known = _known(row, _MOODLE) | {"name": name, "moodle_key": key}
    return Person(f"{name}_{key}", **known)


def moodle_key(identifier: str) -> str | None:
    """The participant's number in an identifier of Moodle's; None if it has none."""
    found = re.search(r"([0-9]+)$", identifier.strip())
    return found[1] if found else None


def _from_gradescope(path: Path, line: int, row: dict[str, str]) -> Person | None:
    """A row of Gradescope's roster; staff are listed in it too."""
    if row.get("Role", "Student").casefold() not in {"", "student"}:
        return None
    name = row.get("Name") or " ".join(filter(None, (row.get("First Name"), row.get("Last Name"))))
    known = _known(row, _GRADESCOPE) | {"name": name}
    student = known["sis_user_id"] or known["email"] or name
    if not student:
        raise _wrong(path, f"line {line}: it names no student")
    return Person(student, section=row.get("Sections", "") or row.get("Section", ""), **known)


def _check_unique(path: Path, people: list[tuple[Person, int]]) -> None:
    for column in ("student", "canvas_id", "sis_user_id", "moodle_key"):
        seen: dict[str, int] = {}
        for person, line in people:
            value = getattr(person, column)
            if value and seen.setdefault(value, line) != line:
                raise _wrong(path, f"{column} {value!r} is in two rows, on lines {seen[value]} and {line}")


def _wrong(path: Path, why: str) -> UsageError:
    advice = (
        "A roster is what Canvas, Moodle or Gradescope hand out, unchanged, or a CSV file with the "
        f"columns {', '.join(COLUMNS)}; all but the first are optional."
    )
    return UsageError(f"{path}: {why}.", help=advice, code="invalid_roster")

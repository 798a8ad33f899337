"""A later roster taken into the stored one: a field that the new file lacks, or leaves empty, stays.

The two rows of one student are found as a student's row is: by the names in the gradebook and the platform's
numbers, then by any id, at last by a name that one row alone has. The new file says who is enrolled, so a row
that only the stored roster has goes.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import msgspec

from course.grading.results.effective import Results, ScoreChange
from course.grading.results.roster import COLUMNS, Person, Roster

Stage = Callable[[Person], list[Person]]

#: Columns whose value is one student's own, the surest first.
_IDS = ("canvas_id", "sis_user_id", "moodle_key", "login", "email")


@dataclass
class Merged:
    """A roster that took the place of another.

    Attributes:
        dropped: students of the earlier roster that the new file does not have.
        moved: the scores that it changes.
    """

    roster: Roster
    dropped: list[str] = field(default_factory=list)
    moved: list[ScoreChange] = field(default_factory=list)


def merged(results: Results, new: Roster, *, lasting: bool = False) -> Merged:
    """The new roster, completed from the one of the results.

    Args:
        lasting: it is to be stored. A Moodle worksheet's numbers are those of one assignment, and do not take
            the place of what a student is known by in Moodle.
    """
    old, graded = results.roster, results.present()
    if old is None:
        return Merged(new)
    found, _ = old.match(graded, results.downloads)
    known = {person.student: name for name, person in found.items()}
    pairs = dict(_pairs(old, list(_stages(results, new, known))))
    earlier = {pairs[person.student].student: person for person in old.people if person.student in pairs}
    own, people = "student" in new.columns, []
    worksheet = new.columns.get("moodle_key", "moodle_key") != "moodle_key"
    for row in new.people:
        before = earlier.get(row.student)
        if before is not None:
            student = _called(before, row, results, graded, own=own, known=before.student in known)
            joined = _joined(before, row, new, student)
            if lasting and worksheet and not before.moodle_key.isdigit():
                joined = msgspec.structs.replace(joined, moodle_key=before.moodle_key or joined.moodle_key)
            people.append(joined)
        else:
            people.append(row)
    columns = {**{name: name for name in old.columns}, **new.columns}
    return Merged(
        Roster(tuple(people), new.file, new.headings, columns),
        [person.student for person in old.people if person.student not in pairs],
    )


def _stages(results: Results, new: Roster, known: dict[str, str]) -> Iterator[Stage]:
    """How the rows of a stored person are looked for, the surest way first."""

    def by_work(person: Person) -> list[Person]:
        name = known.get(person.student)
        return new.rows(name, results.downloads.get(name)) if name is not None else []

    yield lambda person: new.having("student", person.student)
    yield by_work
    for name in _IDS:
        yield lambda person, name=name: new.having(name, getattr(person, name))  # type: ignore[misc]
    yield lambda person: new.rows(person.student)
    yield lambda person: new.having("name", person.name)


def _pairs(old: Roster, stages: list[Stage]) -> Iterator[tuple[str, Person]]:
    """Stored students, each with a row that is about no one else."""
    waiting, taken = {person.student: person for person in old.people}, set[str]()
    for stage in stages:
        claims: dict[str, list[tuple[str, Person]]] = {}
        for student, person in waiting.items():
            rows = [row for row in stage(person) if row.student not in taken]
            if len(rows) == 1:
                claims.setdefault(rows[0].student, []).append((student, rows[0]))
        for (student, row), *others in claims.values():
            if not others:
                del waiting[student]
                taken.add(row.student)
                yield student, row


def _called(
    before: Person, row: Person, results: Results, graded: set[str], *, own: bool, known: bool
) -> str:
    """The name of a student's work: a platform's file makes one up, a roster of your own gives it. ``known``:
    there is work of this student that the earlier row was about."""
    if row.student in graded and (own or not known):
        return row.student
    by_name = before.student in graded and before.student not in results.downloads
    return row.student if own and not by_name else before.student


def _joined(before: Person, row: Person, new: Roster, student: str) -> Person:
    """A row, with what it lacks from the earlier one."""
    kept = {name: getattr(row, name) or getattr(before, name) for name in COLUMNS}
    kept["student"] = student
    if row.extension_days is not None:
        kept["extension_days"] = row.extension_days
    if before.name and ("name" not in new.columns or _is_poorer(row, before.name)):
        kept["name"] = before.name
    for name in _IDS:
        if not getattr(row, name) and new.having(name, kept[name]):
            kept[name] = ""  # the new file says that it is another student's
    return Person(**kept)


def _is_poorer(row: Person, name: str) -> bool:
    """Whether a row's name is only an id, or the known name as a platform sorts it: "Lovelace, Ada"."""
    if row.name.casefold() in {getattr(row, column).casefold() for column in ("student", *_IDS)}:
        return True
    words = sorted(row.name.replace(",", " ").casefold().split())
    return "," in row.name and words == sorted(name.casefold().split())

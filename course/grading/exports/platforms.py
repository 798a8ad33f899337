"""Grades for Canvas and Moodle: a row per student, a column per exercise.

Both find a student by their own id, which only the roster has. An id is written unchanged or not at all: one
that a spreadsheet would take for a formula cannot be escaped without becoming another id.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.errors import UsageError
from course.grading.exports.cells import csv_bytes, for_moodle, is_safe, number, write_bytes
from course.grading.exports.selection import (
    ExportOptions,
    Needs,
    Selection,
    Written,
    check_settled,
    select,
)
from course.grading.results.roster import Column

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from course.grading.results.effective import Results
    from course.grading.results.roster import Person

__all__ = ["write_canvas", "write_moodle"]

_CANVAS = Needs(
    ("canvas_id", "sis_user_id"), "Canvas", "Give Canvas' gradebook export with --roster, or add the column."
)
_MOODLE = Needs(
    ("moodle_key",),
    "Moodle",
    "Add the column: each student's user name, ID number or e-mail address in Moodle. Or fill in Moodle's "
    "grading worksheet: --format moodle-worksheet --roster FILE.",
)


def write_canvas(path: Path, results: Results, options: ExportOptions) -> Written:
    """A file for Canvas' gradebook import.

    Canvas finds a column by the assignment's id, and makes a new assignment of a title without one; so every
    exercise needs its id. An empty cell leaves Canvas' own value.

    Raises:
        UsageError: an assignment's id or the roster is missing.
        MissingCapabilityError: students are missing in the roster, a zero was not looked at, or the file
            cannot be written.
    """
    selection = select(results, options, usable=_has_canvas_id, needs=_CANVAS)
    missing = [name for name in selection.exercises if name not in options.assignments]
    if missing:
        raise UsageError(
            f"Canvas needs the id of the assignment for {missing[0]}.",
            help="Add --assignment EXERCISE=ID (the number at the end of the assignment's address), or "
            "--exercise to export fewer.",
            code="needs_assignment",
        )
    for name, assignment in options.assignments.items():
        if not (assignment.isascii() and assignment.isdigit()):
            raise UsageError(
                f"The assignment's id for {name} is {assignment!r}, not a number.",
                help="It is the number at the end of the assignment's address in Canvas.",
                code="needs_assignment",
            )
        if options.columns and assignment not in options.columns:
            named = ", ".join(column.heading for column in options.columns.values())
            raise UsageError(
                f"Canvas' gradebook has no assignment {assignment}, which was given for {name}. Nothing was"
                " written.",
                help=f"It has {named}.",
                code="needs_assignment",
            )
    check_settled(selection, options)
    most = {exercise.id: exercise.max_points for exercise in results.exercises()}
    titles, possible, notes = [], [], selection.written.notes
    for name in selection.exercises:
        assignment = options.assignments[name]
        column = options.columns.get(assignment, Column(f"{results.title(name)} ({assignment})", None))
        titles.append(column.heading)
        possible.append(column.points or most[name])
        if possible[-1] != most[name]:
            notes.append(
                f"{name} has {number(most[name])} points here and {number(possible[-1])} in Canvas: its"
                " scores are written on Canvas' scale."
            )
    if not options.columns:
        notes.append(
            "Canvas takes a score as points of its own assignment. Give its gradebook with --roster, and the"
            " scores are written on its scale."
        )
    headings = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *titles]
    rows = [["    Points Possible", "", "", "", "", *map(number, possible)]]
    scales = {name: points / most[name] for name, points in zip(selection.exercises, possible, strict=True)}
    for student, scores in _table(selection, scales).items():
        person = selection.people[student]
        rows.append(
            [person.name or student, person.canvas_id, person.sis_user_id, "", person.section, *scores]
        )
    # Ruby's CSV reader, which Canvas uses, fails on a quote after a byte order mark.
    write_bytes(path, csv_bytes(headings, rows, mark=False))
    selection.written.paths.append(path)
    return selection.written


def _has_canvas_id(person: Person) -> bool:
    return bool(person.canvas_id or person.sis_user_id) and is_safe(person.sis_user_id)


def write_moodle(path: Path, results: Results, options: ExportOptions) -> Written:
    """A file for Moodle's grade import, whose columns the teacher maps; an empty cell is no grade.

    Raises:
        UsageError: the roster is missing.
        MissingCapabilityError: students are missing in the roster, a zero was not looked at, or the file
            cannot be written.
    """
    selection = select(results, options, usable=_has_moodle_key, needs=_MOODLE)
    check_settled(selection, options)
    headings = ["moodle_key", "name", "email", *(results.title(name) for name in selection.exercises)]
    rows = []
    for student, scores in _table(selection).items():
        person = selection.people[student]
        rows.append([person.moodle_key, for_moodle(person.name), _address(person), *scores])
    write_bytes(path, csv_bytes(headings, rows))
    selection.written.paths.append(path)
    selection.written.notes.append(_how_to_map(rows))
    return selection.written


def _address(person: Person) -> str:
    """The e-mail address, if Moodle gets it unchanged."""
    mail = person.email
    return mail if is_safe(mail) and for_moodle(mail) == mail else ""


def _how_to_map(rows: list[list[str]]) -> str:
    """What to tell Moodle about the columns: a participant's number is in no field of a user."""
    if all(key.isdigit() for key, *_ in rows):
        mail = ", or map email to 'Email address'" if all(mail for _, _, mail, *_ in rows) else ""
        return (
            "moodle_key has only numbers. Map ID numbers to 'ID number'. Numbers from a grading worksheet are"
            " participant numbers, which no user has as a field; mapped to 'User ID' they would grade other"
            f" people. For these use --format moodle-worksheet{mail}."
        )
    return "In Moodle, map moodle_key to the field that it was taken from: user name, ID number or email."


def _has_moodle_key(person: Person) -> bool:
    key = person.moodle_key
    return bool(key) and is_safe(key) and for_moodle(key) == key


def _table(selection: Selection, scales: Mapping[str, float] | None = None) -> dict[str, list[str]]:
    """Scores by student, in the order of the exercises; empty where there is none.

    Args:
        scales: what a point of an exercise is worth on the platform; 1 if None.
    """
    table: dict[str, list[str]] = {}
    columns = {name: column for column, name in enumerate(selection.exercises)}
    for effective in selection.each():
        row = table.setdefault(effective.student, [""] * len(columns))
        scale = scales[effective.exercise] if scales else 1.0
        row[columns[effective.exercise]] = number(
            None if effective.score is None else effective.score * scale
        )
    return table

"""Grades for Canvas and Moodle: a row per student, a column per exercise.

Both find a student by their own id, which only the roster has. An id is written unchanged or not at all: one
that a spreadsheet would take for a formula cannot be escaped without becoming another id.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.errors import UsageError
from course.grading.exports.cells import csv_bytes, for_moodle, is_safe, number, write_bytes
from course.grading.exports.selection import ExportOptions, Selection, Written, check_zeros, select

if TYPE_CHECKING:
    from pathlib import Path

    from course.grading.results.effective import Results
    from course.grading.results.roster import Person

__all__ = ["write_canvas", "write_moodle"]


def write_canvas(path: Path, results: Results, options: ExportOptions) -> Written:
    """A file for Canvas' gradebook import.

    Canvas finds a column by the assignment's id, and makes a new assignment of a title without one; so every
    exercise needs its id. An empty cell leaves Canvas' own value.

    Raises:
        UsageError: an assignment's id or the roster is missing.
        MissingCapabilityError: students are missing in the roster, a zero was not looked at, or the file
            cannot be written.
    """
    selection = select(results, options, usable=_has_canvas_id, needs="canvas_id or sis_user_id")
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
    check_zeros(selection, options)
    titles = [f"{results.title(name)} ({options.assignments[name]})" for name in selection.exercises]
    headings = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *titles]
    most = {exercise.id: exercise.max_points for exercise in results.exercises()}
    rows = [["    Points Possible", "", "", "", "", *(number(most[name]) for name in selection.exercises)]]
    for student, scores in _table(selection).items():
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
    selection = select(results, options, usable=_has_moodle_key, needs="moodle_key")
    check_zeros(selection, options)
    headings = ["moodle_key", "name", *(results.title(name) for name in selection.exercises)]
    rows = []
    for student, scores in _table(selection).items():
        person = selection.people[student]
        rows.append([person.moodle_key, for_moodle(person.name), *scores])
    write_bytes(path, csv_bytes(headings, rows))
    selection.written.paths.append(path)
    selection.written.notes.append(
        "In Moodle, map the column moodle_key to the field that your roster has in it."
    )
    return selection.written


def _has_moodle_key(person: Person) -> bool:
    key = person.moodle_key
    return bool(key) and is_safe(key) and for_moodle(key) == key


def _table(selection: Selection) -> dict[str, list[str]]:
    """Scores by student, in the order of the exercises; empty where there is none."""
    table: dict[str, list[str]] = {}
    columns = {name: column for column, name in enumerate(selection.exercises)}
    for effective in selection.each():
        row = table.setdefault(effective.student, [""] * len(columns))
        row[columns[effective.exercise]] = number(effective.score)
    return table

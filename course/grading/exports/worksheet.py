"""Moodle's grading worksheet, filled in with grades and feedback.

A teacher downloads it ("Download grading worksheet"), and uploads it again ("Upload grading worksheet").
Moodle finds a row by ``Identifier``, takes ``Grade`` and ``Feedback comments`` from it, refuses a file
without ``Last modified (grade)``, leaves out a grade that is empty, out of range or locked, and one that was
changed in Moodle after the time in that column. An empty feedback cell deletes existing feedback. So
everything but those two cells is written unchanged, and so is the whole row where we have no grade. A row
that has a grade or feedback already, other than ours, is a teacher's: it is kept, and listed.

Source: Moodle's own reader, https://github.com/moodle/moodle/tree/main/mod/assign/feedback/offline
"""

from __future__ import annotations

import csv
import io
import math
from typing import TYPE_CHECKING

from course.errors import UsageError
from course.grading.exports.cells import for_moodle, number, safe_cell, write_bytes
from course.grading.exports.handout import problem_for_student
from course.grading.exports.selection import ExportOptions, Needs, Written, check_settled, select, some
from course.grading.results.roster import in_english, moodle_key, read_text
from course.scoring.numbers import in_points

if TYPE_CHECKING:
    from pathlib import Path

    from course.grading.results.effective import Effective, Results

__all__ = ["write_worksheet"]

_KEY, _GRADE, _MOST = "Identifier", "Grade", "Maximum Grade"
_NEEDS = Needs(("moodle_key",), "Moodle", "Give the worksheet of Moodle's 'Download grading worksheet'.")
_MODIFIED, _FEEDBACK, _OPEN = "Last modified (grade)", "Feedback comments", "Grade can be changed"


def write_worksheet(path: Path, results: Results, options: ExportOptions) -> Written:
    """The worksheet with the grades of one exercise.

    Raises:
        UsageError: there is no worksheet, the file is not one, or there are several exercises.
        MissingCapabilityError: students are missing in the roster, or the file cannot be written.
    """
    if options.worksheet is None:
        raise UsageError(
            "There is no worksheet to fill in.",
            help="Add --roster FILE: the one that Moodle gave with 'Download grading worksheet'.",
            code="needs_roster",
        )
    selection = select(results, options, usable=lambda person: bool(person.moodle_key), needs=_NEEDS)
    if len(selection.exercises) != 1:
        raise UsageError(
            f"A worksheet is about one assignment, and this is about {len(selection.exercises)} exercises.",
            help=f"Add --exercise, one of {', '.join(selection.exercises)}.",
            code="needs_exercise",
        )
    check_settled(selection, options)
    as_given, rows = _read(options.worksheet)
    headings = in_english(as_given)
    mine = {selection.people[one.student].moodle_key: one for one in selection.each()}
    locked, kept, filled = [], [], 0
    for row in rows:
        effective = mine.get(moodle_key(row[headings.index(_KEY)]) or "")
        if effective is None or effective.score is None:
            continue
        if _OPEN in headings and row[headings.index(_OPEN)].strip().casefold() in {"no", "nein"}:
            locked.append(effective.student)
            continue
        ours = {_GRADE: _grade(options.worksheet, effective, _most(headings, row))}
        ours |= {_FEEDBACK: _feedback(effective)} if _FEEDBACK in headings else {}
        theirs = {name: cell for name in ours if (cell := row[headings.index(name)].strip())}
        if any(not _same(cell, ours[name]) for name, cell in theirs.items()) and not options.overwrite:
            kept.append(f"{effective.student} ({', '.join(theirs.values())})")
            continue
        for name, cell in ours.items():
            row[headings.index(name)] = cell
        filled += 1
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\r\n").writerows([as_given, *rows])
    write_bytes(path, text.getvalue().encode("utf-8"))
    written = selection.written
    written.paths.append(path)
    written.rows = filled
    written.notes.append(f"{len(rows) - filled} rows of the worksheet are unchanged.")
    if kept:
        written.kept = kept
        rows_have = "1 row has" if len(kept) == 1 else f"{len(kept)} rows have"
        written.notes.append(
            f"{rows_have} a grade or feedback already and stayed as they were: {some(kept)}. --overwrite"
            " writes ours in their place."
        )
    if locked:
        written.notes.append(
            f"{len(locked)} grades cannot be changed in Moodle, which says so in the worksheet."
        )
    if _FEEDBACK not in headings:
        written.notes.append("The worksheet has no feedback comments: Moodle's feedback type is off.")
    return written


def _same(theirs: str, ours: str) -> bool:
    """Whether a cell says the same: 55.00 and 55 are one grade."""
    try:
        return float(theirs.replace(",", ".")) == float(ours.replace(",", "."))
    except ValueError:
        return theirs == ours.strip()


def _read(path: Path) -> tuple[list[str], list[list[str]]]:
    try:
        headings, *rows = csv.reader(io.StringIO(read_text(path), newline=""), strict=True)
    except (csv.Error, ValueError) as error:
        raise _wrong(path, str(error)) from None
    missing = [name for name in (_KEY, _GRADE, _MODIFIED) if name not in in_english(headings)]
    if missing:
        raise _wrong(path, f"it has no column {missing[0]!r}, without which Moodle does not take it back")
    if any(len(row) != len(headings) for row in rows):
        raise _wrong(path, "a row has another number of cells than the headings")
    return headings, rows


def _most(headings: list[str], row: list[str]) -> str:
    return row[headings.index(_MOST)].strip() if _MOST in headings else ""


def _grade(path: Path, effective: Effective, most: str) -> str:
    """The score on Moodle's scale; its decimal separator is kept."""
    assert effective.score is not None
    if not most:
        return number(effective.score)
    comma = "," in most
    try:
        largest = float(most.replace(",", "."))
    except ValueError:
        largest = math.nan
    if not largest > 0 or not math.isfinite(largest):
        raise _wrong(path, f"its maximum grade is {most!r}, not a number of points")
    share = effective.score / effective.max_score if effective.max_score else 0.0
    # Moodle keeps five digits after the point, and leaves out what is above the maximum.
    text = number(min(share, 1.0) * largest)
    return text.replace(".", ",") if comma else text


def _feedback(effective: Effective) -> str:
    """A result for its student, on one line; of a hidden check only that it failed."""
    verdict = effective.verdict
    problem = problem_for_student(verdict)
    told = [f"{number(effective.score)} of {number(effective.max_score)} points."]
    if effective.penalty:
        told.append(f"Lateness cost {in_points(effective.penalty)}.")
    if effective.override is not None:
        told.append(f"Set by the instructor: {effective.override.reason}")
    elif problem is not None:
        told += [problem.message, problem.help]
    elif verdict.checks:
        passed = sum(check.status.value == "pass" for check in verdict.checks)
        told.append(f"{passed} of {len(verdict.checks)} checks pass.")
    return for_moodle(safe_cell(" ".join(part for part in told if part)))


def _wrong(path: Path, why: str) -> UsageError:
    return UsageError(
        f"{path}: {why}.",
        help="Give the file that Moodle's 'Download grading worksheet' made, unchanged.",
        code="invalid_worksheet",
    )

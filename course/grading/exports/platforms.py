"""Grades for Canvas and Moodle: a row per student, a column per exercise.

Both find a student by their own id, which only the roster has. An id is written unchanged or not at all: one
that a spreadsheet would take for a formula cannot be escaped without becoming another id.
"""

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from course.errors import UsageError
from course.grading.exports.grades import csv_bytes, for_moodle, is_safe, number, safe_cell, write_bytes
from course.grading.exports.selection import (
    SHOWN,
    ExportOptions,
    Needs,
    Selection,
    Written,
    begins,
    check_settled,
    checks_for_student,
    problem_for_student,
    refuse_to_replace,
    select,
)
from course.grading.results.effective import Effective, Results
from course.grading.results.roster import Column, as_there, delimiter_of, in_english, moodle_key, read_text
from course.printable import counted, one_line, some
from course.scoring.verdict import CheckResult, Problem, Status, Visibility, finite, format_points, in_points

_CANVAS = Needs(
    ("canvas_id", "sis_user_id"),
    "Canvas",
    "Give Canvas' gradebook export with --roster, or add the column.",
    lambda person: (person.canvas_id or person.sis_user_id) and is_safe(person.sis_user_id),
)
_MOODLE = Needs(
    ("moodle_key",),
    "Moodle",
    "Add the column: each student's user name, ID number or e-mail address in Moodle. Or fill in Moodle's "
    "grading worksheet: --format moodle-worksheet --roster FILE.",
    lambda person: person.moodle_key and _stays(person.moodle_key),
)


def write_canvas(path: Path, results: Results, options: ExportOptions) -> Written:
    """A file for Canvas' gradebook import.

    Canvas finds a column by its heading, and makes a new assignment of one without an id; so every exercise
    needs its own. An empty cell takes away what Canvas has, an excuse too: where we have no score, what its
    gradebook says is written back.
    """
    selection = select(results, options, _CANVAS)
    _check_assignments(selection, options)
    check_settled(selection, options)
    most = {exercise.id: exercise.max_points for exercise in results.exercises()}
    columns, possible, notes = [], [], selection.written.notes
    for name in selection.exercises:
        assignment = options.assignments[name]
        column = options.columns.get(assignment, Column(f"{results.title(name)} ({assignment})", None))
        columns.append(column)
        possible.append(column.points or most[name])
        if options.columns and not column.points:
            notes.append(
                f"Canvas' gradebook says no points for {one_line(column.heading)}: the scores of {name} are"
                f" written as points of {number(most[name])}."
            )
        if possible[-1] != most[name]:
            notes.append(
                f"{name} has {number(most[name])} points here and {number(possible[-1])} in Canvas: its"
                " scores are written on Canvas' scale."
            )
    if not options.columns:
        notes.append(
            "Canvas takes a score as points of its own assignment, and an empty cell takes away the score or"
            " the excuse (EX) that it has. Give its gradebook with --roster: scores are written on its scale"
            " then, and what Canvas has stays where we have no score."
        )
    headings = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *(one.heading for one in columns)]
    rows = [["    Points Possible", "", "", "", "", *map(number, possible)]]
    scales = {name: points / most[name] for name, points in zip(selection.exercises, possible, strict=True)}
    blind = {(one.student, one.exercise) for one in results.all() if one.missing or one.unsettled}
    for student, scores in _table(selection, scales).items():
        person = selection.people[student]
        for at, (name, column) in enumerate(zip(selection.exercises, columns, strict=True)):
            theirs, ours = column.cells.get(person.canvas_id, ""), scores[at]
            weaker = theirs.upper() == "EX" or (student, name) in blind
            if not theirs or (ours and (options.overwrite or not weaker)):
                continue
            scores[at] = theirs if is_safe(theirs) else ""
            if not scores[at]:
                notes.append(
                    f"Canvas' own {one_line(theirs)!r} for {one_line(student)} {name} begins like a formula"
                    " and is left out: the import takes it away there."
                )
            elif ours and not _same(theirs, ours):
                selection.written.kept.append(f"{student} {name} ({theirs})")
        login = person.login if person.canvas_id and is_safe(person.login) else ""  # as Canvas wrote it
        ids = person.canvas_id, person.sis_user_id, login
        rows.append([person.name or student, *ids, person.section, *scores])
    if selection.written.kept:
        who = "Who is excused in Canvas, or has a score there and nothing graded here,"
        notes.append(f"{who} {_kept(selection.written)}")
    # Ruby's CSV reader, which Canvas uses, fails on a quote after a byte order mark.
    write_bytes(path, csv_bytes(headings, rows, mark=False))
    selection.written.paths.append(path)
    return selection.written


def _check_assignments(selection: Selection, options: ExportOptions) -> None:
    """Refuse exercises without an assignment of their own, and assignments that Canvas has not."""
    missing = [name for name in selection.exercises if name not in options.assignments]
    if missing:
        raise UsageError(
            f"Canvas needs the id of the assignment for {missing[0]}.",
            help="Add --assignment EXERCISE=ID (the number at the end of the assignment's address), or "
            "--exercise to export fewer.",
            code="needs_assignment",
        )
    given: dict[str, str] = {}
    for name in selection.exercises:
        other = given.setdefault(options.assignments[name], name)
        if other != name:
            raise UsageError(
                f"{other} and {name} have one assignment, {options.assignments[name]}: Canvas would take one"
                " of them and drop the other.",
                help="Give each its own assignment's number, or add --exercise to export fewer.",
                code="needs_assignment",
            )
    for name, assignment in options.assignments.items():
        if not (assignment.isascii() and assignment.isdigit()):
            message = f"The assignment's id for {name} is {assignment!r}, not a number."
            advice = "It is the number at the end of the assignment's address in Canvas."
            raise UsageError(message, help=advice, code="needs_assignment")
        if options.columns and assignment not in options.columns:
            named = one_line(", ".join(column.heading for column in options.columns.values()))
            raise UsageError(
                f"Canvas' gradebook has no assignment {assignment}, which was given for {name}. Nothing was"
                " written.",
                help=f"It has {named}.",
                code="needs_assignment",
            )


def _kept(written: Written) -> str:
    listed = some([one_line(one) for one in written.kept], SHOWN)
    return f"stays so: {listed}. --overwrite writes ours in their place."


def write_moodle(path: Path, results: Results, options: ExportOptions) -> Written:
    """A file for Moodle's grade import, whose columns the teacher maps; an empty cell is no grade."""
    selection = select(results, options, _MOODLE)
    check_settled(selection, options)
    headings = ["moodle_key", "name", "email", *(results.title(name) for name in selection.exercises)]
    rows = []
    for student, scores in _table(selection).items():
        person = selection.people[student]
        mail = person.email if _stays(person.email) else ""
        rows.append([person.moodle_key, for_moodle(person.name), mail, *scores])
    write_bytes(path, csv_bytes(headings, rows))
    selection.written.paths.append(path)
    most = {exercise.id: number(exercise.max_points) for exercise in results.exercises()}
    points = ", ".join(f"{name} {most[name]}" for name in selection.exercises)
    selection.written.notes += [
        _how_to_map(rows),
        f"The scores are written as points of the exercise ({points}): give the grade item in Moodle the"
        " same maximum grade.",
    ]
    return selection.written


def _stays(text: str) -> bool:
    """Whether Moodle gets it unchanged."""
    return is_safe(text) and for_moodle(text) == text


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


def _table(selection: Selection, scales: Mapping[str, float] | None = None) -> dict[str, list[str]]:
    """Scores by student, in the order of the exercises; empty where there is none. ``scales`` says what a
    point of an exercise is worth on the platform."""
    table: dict[str, list[str]] = {}
    columns = {name: column for column, name in enumerate(selection.exercises)}
    for effective in selection.each():
        row = table.setdefault(effective.student, [""] * len(columns))
        scale = scales[effective.exercise] if scales else 1.0
        row[columns[effective.exercise]] = number(
            None if effective.score is None else effective.score * scale
        )
    return table


# ---
# Moodle's grading worksheet, filled in with grades and feedback.
#
# docs/instructor.md says what Moodle takes of it. So everything but two cells of a row is written unchanged,
# and so is the whole row where we have no grade, or where a teacher has put another.
#
# Source: Moodle's own reader, https://github.com/moodle/moodle/tree/main/mod/assign/feedback/offline


_KEY, _GRADE, _MOST = "Identifier", "Grade", "Maximum Grade"
_NEEDS = Needs(
    ("moodle_key",),
    "Moodle",
    "Give the worksheet of Moodle's 'Download grading worksheet'.",
    lambda person: person.moodle_key,
)
_MODIFIED, _FEEDBACK, _OPEN = "Last modified (grade)", "Feedback comments", "Grade can be changed"


def write_worksheet(path: Path, results: Results, options: ExportOptions) -> Written:
    """The worksheet with the grades of one exercise.

    Raises:
        UsageError: there is no worksheet, the file is not one, or there are several exercises.
    """
    if options.worksheet is None:
        advice = "Add --roster FILE: the one that Moodle gave with 'Download grading worksheet'."
        raise UsageError("There is no worksheet to fill in.", help=advice, code="needs_roster")
    selection = select(results, options, _NEEDS)
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
    locked, kept, filled, unscaled = [], [], 0, 0
    for row in rows:
        effective = mine.get(moodle_key(row[headings.index(_KEY)]) or "")
        if effective is None or effective.score is None:
            continue
        if _OPEN in headings and row[headings.index(_OPEN)].strip().casefold() in {"no", "nein"}:
            locked.append(effective.student)
            continue
        most = row[headings.index(_MOST)].strip() if _MOST in headings else ""
        ours = {_GRADE: _grade(options.worksheet, effective, most)}
        ours |= {_FEEDBACK: _feedback(effective)} if _FEEDBACK in headings else {}
        theirs = {name: cell for name in ours if (cell := row[headings.index(name)].strip())}
        if any(not _same(cell, ours[name]) for name, cell in theirs.items()) and not options.overwrite:
            kept.append(f"{effective.student} ({', '.join(theirs.values())})")
            continue
        for name, cell in ours.items():
            row[headings.index(name)] = cell
        filled += 1
        unscaled += not most
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\r\n").writerows([as_given, *rows])
    write_bytes(path, text.getvalue().encode("utf-8"))
    written = selection.written
    written.paths.append(path)
    written.rows = filled
    written.notes.append(f"{counted(len(rows) - filled, 'row')} of the worksheet left unchanged.")
    if unscaled:
        name = selection.exercises[0]
        points = {exercise.id: exercise.max_points for exercise in results.exercises()}[name]
        written.notes.append(
            f"The worksheet says no maximum grade for {counted(unscaled, 'row')}: the scores of {name} are"
            f" written there as points of {number(points)}."
        )
    if kept:
        written.kept = kept
        rows_have = "1 row has" if len(kept) == 1 else f"{len(kept)} rows have"
        written.notes.append(f"What {rows_have} already, a grade or feedback, {_kept(written)}")
    if locked:
        written.notes.append(
            f"{counted(len(locked), 'grade')} cannot be changed in Moodle, which says so in the worksheet."
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
    """The headings and the rows. A spreadsheet may have parted them with semicolons; Moodle takes commas."""
    rows: list[list[str]] = []
    text = read_text(path, _wrong)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter_of(text), strict=True)
    try:
        headings = next(reader, [])
        missing = [name for name in (_KEY, _GRADE, _MODIFIED) if name not in in_english(headings)]
        if missing:
            wanted = as_there(missing[0], headings)
            why = f"it has no column {wanted!r}, without which Moodle does not take it back"
            raise _wrong(path, why)
        for row in reader:
            if len(row) != len(headings):
                raise csv.Error("it has another number of cells than the headings")
            rows.append(row)
    except csv.Error as error:
        raise _wrong(path, f"line {reader.line_num}: {error}") from None
    return headings, rows


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
    told = [f"{format_points(effective.score or 0.0)} of {in_points(effective.max_score)}."]
    if effective.penalty:
        told.append(f"Lateness cost {in_points(effective.penalty)}.")
    if effective.override is not None:
        told.append(f"Set by the instructor: {effective.override.reason}")
    elif problem is not None:
        told += [problem.message, problem.help]
    elif verdict.checks:
        passed = sum(check.status.value == "pass" for check in verdict.checks)
        told.append(f"{passed} of {counted(len(verdict.checks), 'check')} pass{'es' * (passed == 1)}.")
    return for_moodle(safe_cell(" ".join(part for part in told if part)))


def _wrong(path: Path, why: str) -> UsageError:
    advice = "Give the file that Moodle's 'Download grading worksheet' made, unchanged."
    return UsageError(f"{path}: {why}.", help=advice, code="invalid_worksheet")


# ---
# Gradescope's ``results.json``: an autograder's answer there, one file per submission.
#
# Everything in it may be shown to the student, so it contains only what students may read. A hidden check is
# shown only after the due date, because students may hand in as often as they like, and could otherwise try
# until it passes.


_WHAT_FOR = (
    "Each JSON file is what an autograder leaves at /autograder/results/results.json for one submission; an "
    "autograder of your own can hand them out. index.csv says whose is which. To grade in Gradescope itself, "
    "use --format gradescope-autograder."
)
_INDEX = ("file", "student", "name", "email", "exercise", "score")
_LONGEST = 4000  # characters of one check's words: a student's function may return anything


def write_gradescope(folder: Path, results: Results, options: ExportOptions) -> Written:
    """A folder with one results file per student and exercise, and ``index.csv``, which names the owners."""
    selection = select(results, options)
    check_settled(selection, options)
    index = folder / "index.csv"
    if not begins(index, csv_bytes(_INDEX, [])):
        refuse_to_replace(folder, [index, folder / "00001.json"], "this folder")
    rows: list[Sequence[str]] = []
    for effective in (item for item in selection.each() if not item.missing):
        # A student's id never becomes a path.
        name = f"{len(rows) + 1:05}.json"
        body = results_body([effective])
        write_bytes(folder / name, msgspec.json.format(msgspec.json.encode(body), indent=1))
        person = selection.people.get(effective.student) or results.person(effective.student)
        about = [person.name, person.email] if person else ["", ""]
        rows.append([name, effective.student, *about, effective.exercise, number(effective.score)])
    write_bytes(index, csv_bytes(_INDEX, rows))
    selection.written.paths += [index, folder]
    selection.written.notes.append(_WHAT_FOR)
    return selection.written


def results_body(found: Sequence[Effective]) -> dict[str, Any]:
    """The body of one ``results.json`` over all exercises of one submission."""
    checks = [(one, checks_for_student(one.verdict)) for one in found]
    tests = [_test(one.exercise, at, check) for one, all_ in checks for at, check in enumerate(all_, 1)]
    problems = [(one, problem_for_student(one.verdict)) for one in found]
    tests += [_not_graded(one, problem) for one, problem in problems if problem is not None]
    # Of the public checks alone: a function's time could reveal its hidden inputs.
    seconds = sum(check.duration_ms for _, all_ in checks for check in all_) / 1e3
    body: dict[str, Any] = {
        "score": round(sum(one.score for one in found if one.score is not None), 4),
        "execution_time": round(seconds, 3),
        "output": "\n\n".join(_words(effective) for effective in found),
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": tests,
        "extra_data": {"results": [_extra(effective) for effective in found]},
    }
    return dict(finite(body))


def _words(effective: Effective) -> str:
    """The text about the submission as a whole."""
    verdict = effective.verdict
    score = "no score yet" if effective.score is None else in_points(effective.score)
    said = [f"{effective.exercise}: {score} of {number(effective.max_score)}."]
    problem = problem_for_student(verdict)
    if problem is not None:
        said += [problem.message, problem.help]
    if effective.penalty:
        said.append(f"Lateness cost {in_points(effective.penalty)}.")
    if effective.override is not None:
        said.append(f"Score set by the instructor: {effective.override.reason}")
    return _plain("\n".join(part for part in (*said, *verdict.warnings) if part))


def _test(exercise: str, number_: int, check: CheckResult) -> dict[str, Any]:
    said = [check.message, check.help, f"Diagnosis: {check.diagnosis}" if check.diagnosis else ""]
    if check.blocked_by:
        said.append(f"Runs once {check.blocked_by} passes.")
    public = check.visibility is Visibility.PUBLIC
    if public and check.expected is not None:
        units = f" {check.units}" if check.units not in {"", "1"} else ""
        what = f" ({check.quantity})" if check.quantity else ""
        said.append(f"Measured {check.actual}{units}{what}, expected {check.expected}{units}.")
    return {
        "name": _plain(check.title),
        "number": f"{exercise}.{number_}",
        "score": check.points,
        "max_score": check.max_points,
        "status": "passed" if check.status is Status.PASS else "failed",
        "output": _plain("\n".join(part for part in said if part))[:_LONGEST],
        "output_format": "text",
        "tags": [exercise, check.task, check.status.value],
        "visibility": "visible" if public else "after_due_date",
        "extra_data": {"id": check.id, "diagnosis": check.diagnosis},
    }


def _not_graded(effective: Effective, error: Problem) -> dict[str, Any]:
    return {
        "name": f"{effective.exercise} could not be graded",
        "score": 0.0,
        "max_score": 0.0,
        "status": "failed",
        "output": _plain(f"{error.message}\n{error.help}"),
        "output_format": "text",
        "tags": [effective.exercise, effective.verdict.state],
        "visibility": "visible",
        "extra_data": {"code": error.code},
    }


def _extra(effective: Effective) -> dict[str, Any]:
    return {
        "exercise": effective.exercise,
        "state": effective.verdict.state,
        "score": effective.score,
        "max_score": effective.max_score,
        "passed": effective.passed,
        "late": effective.late,
        "isolation": effective.verdict.isolation,
        "grader_version": effective.result.key.grader_version,
        "submission_sha256": effective.result.key.submission_sha256,
    }


def _plain(text: str) -> str:
    return "\n".join(one_line(line) for line in text.split("\n"))

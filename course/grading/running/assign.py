"""Files that an instructor assigns to a student: read in place, graded at once, and recorded.

No file is renamed. The graders are those of the run, so the score is the one that the right name would have
given; ``course grade run --resume`` leaves assigned files alone.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from course.catalog.load import Catalog
from course.errors import CourseError, NotFoundError, UsageError
from course.grading.gradebook.file import explained
from course.grading.gradebook.records import Decision, Key, Result, SubmittedAt
from course.grading.intake.downloads import class_list
from course.grading.intake.students import Candidate, Entry, Found, submission_from
from course.grading.results.effective import (
    MISSING,
    Effective,
    Results,
    counted,
    given_reason,
    must_have,
    no_exercise,
)
from course.grading.running.batch import Graded, grade_all
from course.grading.running.run import GradeAll, as_known, assigned_in
from course.grading.running.snapshot import fresh, frozen, kept
from course.printable import command, quoted
from course.scoring.judging.submission import Terms


@dataclass(frozen=True)
class Unsettled:
    """A submission that could not be graded, why, and the candidate files."""

    student: str
    exercise: str
    found: Found
    message: str


@dataclass(frozen=True)
class Assignment:
    """A file to be assigned to a student.

    Attributes:
        name: of the file as it was handed in.
        member: in the archive at ``path``; empty for the file itself.
    """

    student: str
    exercise: str
    name: str
    path: Path
    member: str = ""
    times: tuple[tuple[str, float | None], ...] = ()


@dataclass(frozen=True)
class Assigned:
    """An assignment made or taken back, with what counted before and counts now."""

    assignment: Assignment
    before: Effective | None
    after: Effective | None


def unsettled(results: Results) -> list[Unsettled]:
    """The unsettled cases, ordered by student and exercise; a score by hand settles one."""
    with explained(results.book.path):
        found = results.book.found().items()
        listed = {about: msgspec.json.decode(text, type=Found) for about, text in found}
    return [
        Unsettled(
            item.student, item.exercise, listed.get((item.student, item.exercise), Found(error.code, ())),
            error.message,
        )
        for item in results.all()
        if item.unsettled and (error := item.verdict.error) is not None
    ]  # fmt: skip


def proposals(results: Results) -> list[Assignment]:
    """The proposed matches, at most one for each case."""
    return [_of(one, item) for item in unsettled(results) for one in item.found.candidates if one.proposed]


def named(results: Results, student: str, file: str, exercise: str | None) -> Assignment:
    """The assignment that an instructor means.

    Args:
        file: a name in the list of unsettled cases or in the student's folder, or a path; a slash leads
            into an archive.
        exercise: None where the unsettled case has one, or the course has only one.

    Raises:
        NotFoundError: no such student, exercise or file.
        UsageError: the exercise is not clear.
    """
    student = results.called(student)
    must_have(results, student)
    mine = [item for item in unsettled(results) if item.student == student]
    known = [item.id for item in results.exercises() if item.id != "quiz"]
    if exercise is None:
        called = [(item, one) for item in mine for one in item.found.candidates if one.name == file]
        having = [item for item, _ in called] or mine
        proposing = [item for item, one in called if one.proposed]
        names = {item.exercise for item in proposing or having} or set(known)
        if len(names) != 1:
            message = f"Which exercise {file} is for does not follow."
            advice = f"Add --exercise, one of {', '.join(sorted(names))}."
            raise UsageError(message, help=advice, code="needs_exercise")
        exercise = names.pop()
    elif exercise == "quiz":
        raise UsageError(
            "A quiz is graded from its record, which no file is assigned for.",
            help="Leave one zip of `course submit` in the student's folder and grade with --resume, or give "
            "the score with `course grade override`.",
            code="needs_exercise",
        )
    elif exercise not in known:
        raise no_exercise(exercise, known)
    times: tuple[tuple[str, float | None], ...] = ()
    for item in mine:
        if item.exercise == exercise:
            times = item.found.times
            inside = [one for one in item.found.candidates if one.name.startswith(f"{file}/") and one.defines]
            for one in item.found.candidates:
                if one.name == file and len(inside) != 1:
                    return _of(one, item)
            if len(inside) == 1:  # of an archive, the one file with functions in it
                return _of(inside[0], item)
    place = _cut(Path(file)) or _lying(results, student, file)
    if place is None:
        advice = f"Name it as {command('grade', 'assign', results.folder)} lists it, or by its path."
        raise NotFoundError(f"There is no file {file}.", help=advice, code="file_not_found")
    return Assignment(student, exercise, file, *place, times)


def _of(one: Candidate, item: Unsettled) -> Assignment:
    path = Path(os.fsdecode(one.path))
    return Assignment(item.student, item.exercise, one.name, path, one.member, item.found.times)


def _lying(results: Results, student: str, file: str) -> tuple[Path, str] | None:
    """A file by its name in the student's folder, or its name on the platform; None if it is not there."""
    known = results.book.run_options() | results.book.meta()  # an older version noted it with the run
    try:
        found = class_list(Path(known.get("folder", "")), known.get("layout", "auto"))
    except CourseError:
        return None
    place = next((one.place for one in as_known(found, results.book) if one.name == student), None)
    if place is None:
        return None
    if place.files is None:
        # As lists call it: a folder around everything was passed over.
        return _cut(place.unwrapped(()).root / file) or _cut(place.root / file)
    above, _, member = file.partition("/")
    return next(((path, member) for name, path in place.files if name == above), None)


def _cut(path: Path) -> tuple[Path, str] | None:
    """A path, cut in two where it leads into an archive; None if there is no such file."""
    if os.path.lexists(path):
        return path, ""
    return next(((one, path.relative_to(one).as_posix()) for one in path.parents if one.is_file()), None)


def assign(
    results: Results,
    catalog: Catalog,
    assignments: Sequence[Assignment],
    reason: str,
    *,
    grade: GradeAll = grade_all,
    level: str | None = None,
    at_least: str = "L2",
    accepted: str = "",
) -> list[Assigned]:
    """Accept files as submissions, and grade them with the graders of the run.

    Args:
        results: over a gradebook opened for writing.
        level, at_least: as in ``Terms``.
        accepted: as in ``RerunOptions``.

    Raises:
        UngradableError: a file cannot be read.
        UsageError: there is no reason, or the run's graders are not this checkout's.
    """
    reason = given_reason(reason, "An assignment", "it is kept with the result")
    book, options = results.book, results.book.run_options()
    snapshot = kept(book, options.get("snapshot"), catalog.content, accepted) or fresh(catalog.content)
    timeout = float(options.get("timeout", 10.0))
    done: list[Assigned] = []
    with frozen(snapshot) as graders:
        asked, entries = {(one.student, one.exercise): one for one in assignments}, []
        for one in asked.values():
            exercise = graders.catalog.exercise(one.exercise)
            entries.append(Entry(one.student, exercise, submission_from(exercise, one.path, one.member)))
        terms = Terms(level, at_least, timeout, results.seed, snapshot.sha256)
        for graded in list(grade(entries, terms)):
            if not done:
                book.keep_snapshot(snapshot.sha256, snapshot.packed)
                facts = {"level": level, "at_least": at_least, "snapshot": snapshot.sha256}
                book.begin_run("assign", {**options, **facts})
            one = asked[graded.entry.student, graded.entry.exercise.id]
            version = graded.version or graders.version(one.exercise)
            done.append(_recorded(results, one, graded, version, reason))
    return done


def _recorded(results: Results, one: Assignment, graded: Graded, version: str, reason: str) -> Assigned:
    """Store the verdict on an assigned file, its times, and the decision."""
    book, entry = results.book, graded.entry
    assert entry.submission is not None
    before = next(results.all(one.student, one.exercise), None)
    note = f"Graded from {quoted(one.name)}, assigned by the instructor: {reason}"
    verdict = msgspec.structs.replace(graded.verdict, warnings=(*graded.verdict.warnings, note))
    key = Key(one.student, one.exercise, entry.sha256, version, results.seed)
    book.add(Result(key, verdict), dict(entry.submission.files))
    book.add_times(
        SubmittedAt(one.student, one.exercise, entry.sha256, source, at) for source, at in one.times
    )
    after = next(Results(book).all(one.student, one.exercise))
    told = counted(before), counted(after, one.name)
    book.note(Decision("", "", "assign", one.student, one.exercise, reason, *told))
    book.set_found(one.student, one.exercise, None)
    return Assigned(one, before, after)


def lift(results: Results, student: str, exercise: str | None, reason: str) -> Assigned:
    """Take back the file that was assigned to a student: what counted before counts again, or nothing.

    Args:
        results: over a gradebook opened for writing.
        exercise: None where the student has one assigned file.

    Raises:
        NotFoundError: no such student, or no assigned file counts.
        UsageError: the exercise is not clear.
    """
    book, student = results.book, results.called(student)
    must_have(results, student)
    counts = {item.exercise: item for item in results.all(student)}
    assigned = {
        task: (earlier, file)
        for (who, task), (earlier, sha256, file) in assigned_in(book).items()
        if who == student and task in counts and counts[task].result.key.submission_sha256 == sha256
    }
    names = sorted(assigned) if exercise is None else [exercise]
    if len(names) > 1:
        message, advice = (
            f"{student!r} has several assigned files.",
            f"Add --exercise, one of {', '.join(names)}.",
        )
        raise UsageError(message, help=advice, code="needs_exercise")
    if not names or names[0] not in assigned:
        message = f"No assigned file counts for {student!r}{f' and {exercise}' if exercise else ''}."
        advice = f"{command('grade', 'log', results.folder, student)} lists what was assigned."
        raise NotFoundError(message, help=advice, code="no_assignment")
    task = names[0]
    before, (earlier, file) = counts[task], assigned[task]
    if not earlier or not book.confirm(replace(before.result.key, submission_sha256=earlier)):
        book.take_back(before.result.key, results.nothing(student, task, MISSING).verdict)
    after = next(Results(book).all(student, task), None)
    told = counted(before, file), counted(after)
    book.note(Decision("", "", "assign", student, task, reason.strip() or "taken back", *told))
    return Assigned(Assignment(student, task, file, Path()), before, after)

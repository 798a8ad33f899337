"""The content of an export, who is left out, and why; the same for every format."""

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from course.errors import MissingCapabilityError, UsageError
from course.grading.results.effective import Effective, Results, no_exercise
from course.grading.results.roster import FOR_TESTS, Column, Person
from course.printable import command, one_line, some
from course.scoring.verdict import CheckResult, Problem, Status, Verdict, Visibility, for_student

#: Names in a message.
SHOWN = 10


@dataclass(frozen=True)
class ExportOptions:
    """The options of an export.

    Attributes:
        exercises: ids; empty takes all.
        assignments: exercise id -> id of the assignment on the platform.
        partial: leave out students who are not in the roster, instead of stopping.
        missing: "blank" or "zero", for work that an enrolled student did not hand in.
        zeros: work that could not be graded may be written as 0, although the instructor has not looked at
            it.
        worksheet: Moodle's file to fill in.
        columns: of the platform's file, by the id of the assignment; empty if it was not given.
        overwrite: what the platform's file has already (a grade, feedback, an excuse) gives way to ours.
    """

    exercises: tuple[str, ...] = ()
    assignments: dict[str, str] = field(default_factory=dict)
    partial: bool = False
    missing: str = "blank"
    zeros: bool = False
    worksheet: Path | None = None
    overwrite: bool = False
    columns: Mapping[str, Column] = field(default_factory=dict)


@dataclass(frozen=True)
class Needs:
    """The key by which a platform finds a student.

    Attributes:
        columns: of our own roster, one of which has to have it.
        give: where to get the key, as the beginning of a sentence.
        usable: whether a row has the key, as this format can write it.
    """

    columns: tuple[str, ...]
    platform: str
    give: str
    usable: Callable[[Person], object]

    def absent(self) -> str:
        """What a roster lacks that has none of the columns."""
        if len(self.columns) == 1:
            return f"has no {self.columns[0]}, and {self.platform} needs it"
        return f"has neither {' nor '.join(self.columns)}, and {self.platform} needs one of them"


@dataclass
class Written:
    """The result of an export.

    Attributes:
        unmatched: students left out.
        without_grade: "student exercise" of results without a score because the grader failed.
        kept: rows of a platform's file that have a grade, feedback or an excuse of a teacher's, with it.
        notes: what the instructor should know, one sentence each.
    """

    paths: list[Path] = field(default_factory=list)
    rows: int = 0
    unmatched: list[str] = field(default_factory=list)
    without_grade: list[str] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass
class Selection:
    """The results of an export.

    Attributes:
        people: student -> row of the roster; empty without one.
        zeros: work that was not handed in counts as 0.
    """

    results: Results
    exercises: tuple[str, ...]
    people: dict[str, Person]
    written: Written
    zeros: bool = False

    def each(self) -> Iterator[Effective]:
        """The results, ordered by student and exercise; missing ones are noted on the way."""
        left_out = set(self.written.unmatched)
        for one in self.results.all():
            if one.exercise not in self.exercises or one.student in left_out:
                continue
            if one.score is None and not (one.missing or one.waiting):
                self.written.without_grade.append(f"{one.student} {one.exercise}")
            self.written.rows += 1
            yield replace(one, score=0.0) if self.zeros and one.missing else one


def select(results: Results, options: ExportOptions, needs: Needs | None = None) -> Selection:
    """Select the content of an export.

    Args:
        needs: the key this format finds people by; without one a roster is not needed.

    Raises:
        NotFoundError: no such exercise.
        UsageError: this format needs a roster.
        MissingCapabilityError: the roster lacks students, and ``partial`` was not asked for.
    """
    known = {exercise.id for exercise in results.exercises()}
    unknown = [name for name in (*options.exercises, *options.assignments) if name not in known]
    if unknown:
        raise no_exercise(unknown[0], sorted(known))
    if needs and results.roster is None:
        message = "This format finds students by the platform's ids, which are in a roster."
        advice = "Add --roster FILE; docs/instructor.md shows one."
        raise UsageError(message, help=advice, code="needs_roster")
    written = Written()
    people: dict[str, Person] = {}
    key = " or ".join(needs.columns) if needs else ""
    if results.roster is not None:
        # A roster in which nobody has the platform's key: a list of all students would hide that.
        rows = results.roster.people
        if needs and not any(getattr(person, name) for person in rows for name in needs.columns):
            message = f"{results.roster.called} {needs.absent()}. Nothing was written."
            raise MissingCapabilityError(message, help=needs.give, code="unmatched_students")
        people, unmatched = results.roster.match(results.students(), results.downloads)
        if needs:
            keyless = [student for student, person in people.items() if not needs.usable(person)]
            unmatched |= dict.fromkeys(keyless, f"No usable {key}")
            people = {student: person for student, person in people.items() if needs.usable(person)}
        tests = [student for student, why in unmatched.items() if why == FOR_TESTS]
        blocking = {student: why for student, why in unmatched.items() if why != FOR_TESTS}
        if blocking and not options.partial:
            raise _unmatched(results, blocking, key)
        if tests and needs:
            written.notes.append(f"{some(tests, SHOWN)} is {FOR_TESTS} and was left out.")
        written.unmatched = sorted(unmatched)
    exercises = options.exercises or tuple(exercise.id for exercise in results.exercises())
    if needs and not options.exercises:
        # A platform needs no columns without grades.
        there = {effective.exercise for effective in results.all()}
        exercises = tuple(name for name in exercises if name in there) or exercises
    return Selection(results, exercises, people, written, options.missing == "zero")


def check_settled(selection: Selection, options: ExportOptions) -> None:
    """Refuse to tell a platform what is not known yet, or a zero that the instructor has not confirmed.

    Raises:
        MissingCapabilityError: a run has still to look at somebody's work; or something could not be graded,
            or is nobody's and may be a missing student's, and neither a score by hand nor ``zeros`` says that
            it is worth 0.
    """
    left_out = set(selection.written.unmatched)
    asked = [item for item in selection.results.all() if item.exercise in selection.exercises]
    unread = {item.student for item in asked if item.waiting}
    waiting = sorted(map(repr, (selection.results.waiting | unread) - left_out))
    if waiting:
        are = "1 student is" if len(waiting) == 1 else f"{len(waiting)} students are"
        raise MissingCapabilityError(
            f"{are} not graded yet: {some(waiting, SHOWN)}. Nothing was written.",
            help="Nothing says that this was not handed in. `course grade run` with --resume, for these"
            " exercises and without --only, looks for it.",
            code="not_graded_yet",
        )
    mine = [item for item in asked if item.student not in left_out]
    if not any(item.score is not None for item in mine) and (left_out or not mine):
        raise MissingCapabilityError(
            "No student in the roster has a score for this export. Nothing was written.",
            help=f"Is it the roster of this class? Not in it: {some(sorted(map(repr, left_out)), SHOWN)}."
            if left_out
            else f"Nobody handed in {', '.join(selection.exercises)}.",
            code="unmatched_students",
        )
    if options.zeros:
        return
    unseen = [
        f"{item.student!r} {item.exercise} ({item.verdict.error.code if item.verdict.error else 'no reason'})"
        for item in mine
        if item.unsettled
    ]
    if unseen:
        raise MissingCapabilityError(
            f"{len(unseen)} could not be graded and would get 0: {some(unseen, SHOWN)}. Nothing was written.",
            help=f"{command('grade', 'assign', selection.results.folder)} lists them and how to settle"
            " each; --accept-zeros writes the zeros.",
            code="unseen_zeros",
        )
    unowned = selection.results.unowned()
    if unowned and any(item.missing for item in mine):
        raise MissingCapabilityError(
            f"{len(unowned)} of unknown owner may be the work of a student who counts as having handed in"
            f" nothing: {some(unowned, SHOWN)}. Nothing was written.",
            help="Move each into its student's folder, or away, and give `course grade run` with --resume, or"
            f" {command('grade', 'assign', selection.results.folder, 'STUDENT', 'FILE')}; --accept-zeros"
            " passes over them.",
            code="unknown_owner",
        )


def begins(path: Path, mark: bytes) -> bool:
    """Whether there is a file that begins so."""
    with contextlib.suppress(OSError), path.open("rb") as handle:
        return handle.read(len(mark)) == mark
    return False


def refuse_to_replace(folder: Path, files: Iterable[Path], made: str) -> None:
    """Refuse to replace files in a folder which no export to ``made`` wrote.

    Raises:
        UsageError: one of them is there.
    """
    if names := [one_line(str(file.relative_to(folder))) for file in sorted(files) if file.exists()]:
        message = f"{folder} has {some(names, 3)}, and no export to {made} made it. Nothing was written."
        raise UsageError(message, help="Name a folder without it: -o FOLDER.", code="out_exists")


def is_part(results: Results, options: ExportOptions) -> bool:
    """Whether the export leaves out something that is in the gradebook."""
    if options.exercises and {exercise.id for exercise in results.exercises()} - set(options.exercises):
        return True
    return options.partial and bool(results.unmatched(results.students()))


def _unmatched(results: Results, why: dict[str, str], needs: str) -> MissingCapabilityError:
    assert results.roster is not None
    by_reason: dict[str, list[str]] = {}
    for student, reason in sorted(why.items()):
        by_reason.setdefault(reason, []).append(repr(student))
    listed = " ".join(f"{reason}: {some(names, SHOWN)}." for reason, names in by_reason.items())
    key = f" and {needs}" if needs else ""
    joined = any(reason.startswith("In one row") for reason in by_reason)
    twice = (
        "Who had another name in an earlier download is one student in a new run (another --out). "
        if joined
        else ""
    )
    about = "1 student" if len(why) == 1 else f"{len(why)} students"
    return MissingCapabilityError(
        f"{results.roster.called} has no usable row for {about}. {listed} "
        f"{results.roster.compared(why, results.downloads)} Nothing was written.",
        help="Correct it, or give a CSV file of your own with the columns student (the name in the gradebook)"
        f"{key}. {twice}--partial leaves these students out.",
        code="unmatched_students",
    )


# ---
# A verdict as its student may read it; everything that students get is made from this.


#: The message of a broken check may contain its hidden values.
_OUR_FAULT = Problem(
    "grader_error",
    "A fault of the grader, not of yours, kept this from being graded.",
    "It will be graded again. Your instructor knows of it.",
)


def checks_for_student(verdict: Verdict) -> tuple[CheckResult, ...]:
    """The checks, hidden values dropped; none where the grader itself failed.

    Where every public check finds a function unwritten, what is hidden says no more than that.
    """
    if verdict.state == "grader_error":
        return ()
    checks = tuple(map(for_student, verdict.checks))
    public = [check for check in checks if check.visibility is Visibility.PUBLIC]
    begun = {check.task for check in public if not check.unwritten and check.status is not Status.SKIP}
    unwritten = {check.task: check for check in public if check.unwritten and check.task not in begun}
    return tuple(
        msgspec.structs.replace(check, message=known.message, help=known.help, diagnosis=known.diagnosis)
        if check.status is Status.ERROR and (known := unwritten.get(check.task))
        else check
        for check in checks
    )


def problem_for_student(verdict: Verdict) -> Problem | None:
    """Why there is no grade; details of a fault in the grader stay with the instructor."""
    return _OUR_FAULT if verdict.state == "grader_error" else verdict.error

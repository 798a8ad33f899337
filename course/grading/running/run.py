"""A grading run from folder to gradebook: what ``course grade run`` does, without the words."""

from __future__ import annotations

import contextlib
import secrets
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from course.catalog.questions import read_questions
from course.errors import CourseError, MissingCapabilityError, UngradableError, UsageError
from course.grading.exports.html_report.write import write_pages
from course.grading.exports.lines import write_csv, write_jsonl
from course.grading.gradebook.book import Gradebook, GradedExercise, Key, Result, SubmittedAt
from course.grading.intake.downloads import class_list
from course.grading.intake.students import Entry, read_quiz, read_student, witnesses
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.quiz import grade_quiz, quiz_version, record_sha256
from course.grading.results.effective import Results
from course.grading.running.batch import grade_all
from course.quizzing.attempt import needed
from course.quizzing.bank import Bank
from course.scoring.terms import Terms
from course.scoring.version import grader_version

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from pathlib import Path

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.grading.intake.downloads import ClassList, Student
    from course.grading.results.effective import Effective
    from course.grading.results.roster import Roster
    from course.grading.running.batch import Graded

    #: What turns entries into verdicts: processes on this machine, or anything else that does the same.
    GradeAll = Callable[[Iterable[Entry], Terms], Iterator[Graded]]

__all__ = ["QUIZ_RECORD", "RunOptions", "Summary", "Trouble", "export_all", "grade_class", "open_results"]

#: What a quiz record is called among the submissions in a gradebook.
QUIZ_RECORD = "quiz.json"
_TIMES_AT_ONCE = 256


@dataclass(frozen=True)
class RunOptions:
    """How a class is graded.

    Attributes:
        exercises: ids asked for by name, "quiz" among them; empty takes all, and then an exercise nobody
            handed in is no fault.
        only: students to grade; empty takes all.
        terms: protection, deadline; their seed is not asked for.
        seed: of the run; None draws one, and a resumed run keeps its own.
        layout: what kind of folder it is; "auto" finds out.
        roster: who is enrolled; None leaves what the gradebook remembers.
    """

    exercises: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    terms: Terms = Terms(at_least="L2")  # noqa: RUF009 - it cannot change
    seed: int | None = None
    resume: bool = False
    layout: str = "auto"
    roster: Roster | None = None


class Trouble(msgspec.Struct, frozen=True):
    """One submission without a grade."""

    student: str
    exercise: str
    state: str
    code: str
    message: str


@dataclass
class Summary:
    """What a run came to.

    Attributes:
        states: number of results by state.
        troubled: the results without a grade.
        not_submitted: pairs without a file, which count for nothing.
        already: results that an earlier run had.
        missing: who is enrolled and handed in nothing at all; empty without a roster.
        strangers: who handed in something and has no row of their own in the roster.
        unrecognised: what in the class folder belongs to nobody, one sentence each.
        elapsed_s: wall seconds.
        write_s: of these, spent on writing the gradebook.
    """

    states: Counter[str] = field(default_factory=Counter)
    passed: int = 0
    troubled: list[Trouble] = field(default_factory=list)
    not_submitted: int = 0
    missing: list[str] = field(default_factory=list)
    strangers: list[str] = field(default_factory=list)
    already: int = 0
    levels: Counter[str] = field(default_factory=Counter)
    unrecognised: list[str] = field(default_factory=list)
    seed: int = 0
    elapsed_s: float = 0.0
    write_s: float = 0.0

    @property
    def exit_code(self) -> int:
        """70 if any fault was ours, 6 if anything could not be graded, else 0 whatever the scores."""
        if self.states["grader_error"]:
            return 70
        return 6 if self.states["ungradable"] or self.unrecognised else 0

    def count(self, results: Results) -> None:
        """Take in everything a gradebook has."""
        self.missing = results.absent()
        self.strangers = results.unmatched(results.students())
        for effective in results.all():
            verdict = effective.verdict
            if effective.missing:
                continue
            settled = effective.override is not None  # by hand, whatever the graders could make of it
            self.states["graded" if settled else verdict.state] += 1
            self.passed += effective.passed
            if verdict.isolation:
                self.levels[verdict.isolation] += 1
            if verdict.error is not None and not settled:
                error = verdict.error
                self.troubled.append(
                    Trouble(effective.student, effective.exercise, verdict.state, error.code, error.message)
                )


def grade_class(
    folder: Path,
    out: Path,
    catalog: Catalog,
    options: RunOptions,
    report: Callable[[Effective, int, int], None],
    *,
    grade: GradeAll = grade_all,
) -> Summary:
    """Grade every submission below ``folder`` into ``out``.

    Args:
        report: called with each new result, how many students are done, and how many there are.
        grade: what turns entries into verdicts; it is handed only what is left to do, and this process
            remains the only one that writes.

    Raises:
        MissingCapabilityError: there are no hidden graders here, no sufficient protection, or no room.
        NotFoundError: no such folder, exercise or student.
        UsageError: ``out`` exists, is in use, or lies among the submissions.
    """
    if catalog.content.graders is None:
        raise MissingCapabilityError(
            "This installation has no hidden graders: it is a student's.",
            help="Grade from a checkout of the course.",
            code="needs_checkout",
        )
    exercises = _exercises(catalog, options.exercises)
    members = _members(folder, options)
    started = time.monotonic()
    with _taken_back(out) as taken, _open(out, folder, options) as book:
        run = _Run(members.students, exercises, catalog, options, book)
        for result, files in run.results(grade):
            book.add(result, files)
            taken.graded |= bool(result.verdict.isolation)
            report(run.view.of(result), run.done, len(members.students))
        run.note_times()
        summary = run.summary
        summary.unrecognised = members.unrecognised
        results = Results(book)
        summary.count(results)
        export_all(out, results)
        summary.write_s = book.write_s
    summary.elapsed_s = time.monotonic() - started
    return summary


class _Run:
    """One run over a class, with a gradebook to write to."""

    def __init__(
        self,
        students: Sequence[Student],
        exercises: Sequence[Exercise],
        catalog: Catalog,
        options: RunOptions,
        book: Gradebook,
    ) -> None:
        self._students = students
        self._exercises = exercises
        self._catalog = catalog
        self._options = options
        self._book = book
        self._versions = {exercise.id: grader_version(exercise, catalog) for exercise in exercises}
        self._times: list[SubmittedAt] = []
        self._bank = Bank(read_questions(catalog.content.quiz))
        self._with_quiz = bool(self._bank.ids) and (not options.exercises or QUIZ in options.exercises)
        self.summary = Summary(seed=_seed(book, options))
        self.done = 0
        self._open: Counter[str] = Counter()
        self._note_facts()
        self.view = Results(book)

    def _note_facts(self) -> None:
        options, book = self._options, self._book
        course = self._catalog
        book.set_meta(seed=str(self.summary.seed), course=course.course_id, version=course.version)
        if options.roster is not None:
            book.set_meta(roster=options.roster.dump())
        terms = options.terms
        facts = {"level": terms.level, "at_least": terms.at_least, "timeout": terms.timeout}
        if not (options.resume and book.run_options()):
            book.begin_run("run", facts)
        book.set_exercises(graded_exercises(self._exercises, self._bank if self._with_quiz else None))
        book.set_students({who.name: who.identity for who in self._students if who.identity is not None})

    def results(self, grade: GradeAll) -> Iterator[tuple[Result, dict[str, bytes] | None]]:
        """What is left to be graded, graded; with what was handed in."""
        terms = msgspec.structs.replace(self._options.terms, seed=self.summary.seed)
        for graded in grade(self._left_to_do(), terms):
            submission = graded.entry.submission
            self._one_less(graded.entry.student)
            yield (
                Result(self._key(graded.entry), graded.verdict),
                dict(submission.files) if submission else None,
            )
        if self._with_quiz:
            yield from self._quizzes()

    def _key(self, entry: Entry) -> Key:
        version = self._versions[entry.exercise.id]
        return Key(entry.student, entry.exercise.id, entry.sha256, version, self.summary.seed)

    def _left_to_do(self) -> Iterator[Entry]:
        for student in self._students:
            self._open[student.name] += 1
            for entry in read_student(student, self._exercises, required=bool(self._options.exercises)):
                if entry.submission is None and entry.problem is None:
                    self.summary.not_submitted += 1
                    continue
                self._witnessed(entry.times)
                if self._options.resume and self._book.confirm(self._key(entry)):
                    self.summary.already += 1
                    continue
                self._open[student.name] += 1
                yield entry
            self._one_less(student.name)

    def _one_less(self, student: str) -> None:
        """A student is done when all they handed in was read and everything read is graded."""
        self._open[student] -= 1
        if not self._open[student]:
            del self._open[student]
            self.done += 1

    def _quizzes(self) -> Iterator[tuple[Result, dict[str, bytes]]]:
        """The quiz attempts that came with the submissions, scored here: no student's code is involved."""
        version = quiz_version(self._bank)
        for student in self._students:
            path = None
            try:
                record, path = read_quiz(student)
            except UngradableError as error:
                record = error.code  # no list of attempts, which the scoring says of it
            verdict = grade_quiz(self._bank, record)
            if verdict is None:
                continue
            key = Key(student.name, QUIZ, record_sha256(record), version, self.summary.seed)
            self._witnessed(witnesses(student, QUIZ, key.submission_sha256, path))
            if self._options.resume and self._book.confirm(key):
                self.summary.already += 1
            else:
                yield Result(key, verdict), {QUIZ_RECORD: _as_json(record)}

    def _witnessed(self, times: tuple[SubmittedAt, ...]) -> None:
        self._times += times
        if self.view.policy is not None:
            self.view.take_in(times)
        if len(self._times) >= _TIMES_AT_ONCE:
            self.note_times()

    def note_times(self) -> None:
        """Put what is known about when things were handed in into the gradebook."""
        if self._times:
            self._book.add_times(self._times)
        self._times.clear()


def _as_json(record: object) -> bytes:
    with contextlib.suppress(TypeError, ValueError, RecursionError, msgspec.MsgspecError):
        return msgspec.json.encode(record)
    return b"null"  # what cannot be written again was ungradable, and stays so


def graded_exercises(exercises: Sequence[Exercise], bank: Bank | None) -> list[GradedExercise]:
    """What a gradebook notes about exercises, and about the quiz if there is one."""
    noted = [
        GradedExercise(item.id, item.title, item.max_points, item.pass_mark, item.order) for item in exercises
    ]
    if bank is not None:
        total = len(bank.ids)
        noted.append(GradedExercise(QUIZ, "Quiz", float(total), needed(total) / total, 1_000_000))
    return noted


def export_all(out: Path, results: Results) -> None:
    """The files that lie beside a gradebook after every run.

    Raises:
        MissingCapabilityError: one cannot be written; the gradebook has everything nevertheless.
    """
    try:
        write_jsonl(out / "results.jsonl", results.all(), results.course)
        write_csv(out / "grades.csv", results)
        write_pages(out / "report.html", results, results.all(), [item.id for item in results.exercises()])
    except MissingCapabilityError as error:
        raise MissingCapabilityError(
            error.message,
            help="The gradebook is complete. Make room, then give the same command again (a run with"
            " --resume): only this is missing. `course grade export` writes it elsewhere.",
            code=error.code,
        ) from None


@contextlib.contextmanager
def open_results(out: Path, *, writing: bool = False) -> Iterator[Results]:
    """The results in the folder of a grading run.

    Args:
        writing: hold the gradebook, and write what lies beside it anew at the end.
    """
    with Gradebook(out / "gradebook.sqlite", writing=writing) as book:
        yield Results(book)
        if writing:
            export_all(out, Results(book))


def _exercises(catalog: Catalog, wanted: tuple[str, ...]) -> tuple[Exercise, ...]:
    if not wanted:
        return catalog.exercises()
    return tuple(catalog.exercise(name) for name in dict.fromkeys(wanted) if name != QUIZ)


def _members(folder: Path, options: RunOptions) -> ClassList:
    found = class_list(folder, options.layout)
    if options.only:
        unknown = sorted(set(options.only) - {student.name for student in found.students})
        if unknown:
            raise UsageError(
                f"{folder} has no student {unknown[0]!r}.",
                help="--only takes the name of a student's folder.",
                code="student_not_found",
            )
        found.students = [student for student in found.students if student.name in options.only]
        found.unrecognised = []
    return found


@dataclass
class _Taken:
    """A name for the results that is taken. ``graded``: whether any grader could work."""

    graded: bool = False


@contextlib.contextmanager
def _taken_back(out: Path) -> Iterator[_Taken]:
    """Give the name of a new folder back if the run is refused before anything was graded in it.

    The next command is the same one, corrected, and must not find its own folder in the way.
    """
    new, taken = not out.exists(), _Taken()
    try:
        yield taken
    except CourseError:
        if new and not taken.graded and out.is_dir():
            for item in out.iterdir():
                item.unlink()
            out.rmdir()
        raise


def _open(out: Path, folder: Path, options: RunOptions) -> Gradebook:
    if out.resolve().is_relative_to(folder.resolve()):
        raise UsageError(
            f"--out {out} lies among the submissions.",
            help="Name a folder elsewhere.",
            code="out_inside_submissions",
        )
    path = out / "gradebook.sqlite"
    if options.resume and path.exists():
        return Gradebook(path, writing=True)
    try:
        out.mkdir(parents=True)
    except FileExistsError:
        # Killed before its gradebook was made, a run leaves the folder and perhaps the draft.
        begun = (
            options.resume
            and out.is_dir()
            and all(item.name.startswith("gradebook.new") for item in out.iterdir())
        )
        if not begun:
            raise UsageError(
                f"{out} exists already; nothing was touched.",
                help="Name a new folder, or add --resume to finish the run that is there.",
                code="out_exists",
            ) from None
        for draft in out.iterdir():
            draft.unlink(missing_ok=True)
    except OSError as error:
        raise MissingCapabilityError(
            f"{out} cannot be made: {error.strerror}.",
            help="Name a folder that can be written.",
            code="read_only",
        ) from None
    return Gradebook(path, create=True, writing=True)


def _seed(book: Gradebook, options: RunOptions) -> int:
    recorded = book.meta().get("seed")
    if recorded is not None and options.seed not in (None, int(recorded)):
        raise UsageError(
            f"This gradebook was begun with --seed {recorded}.",
            help="Leave --seed out to go on, or grade into a new folder.",
            code="other_seed",
        )
    if recorded is not None:
        return int(recorded)
    return options.seed if options.seed is not None else secrets.randbits(31)

"""A grading run from folder to gradebook: what ``course grade run`` does, without the words."""

from __future__ import annotations

import secrets
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from course.catalog.questions import read_questions
from course.errors import MissingCapabilityError, UngradableError, UsageError
from course.grading.batch import BatchOptions, grade_all
from course.grading.exports.lines import CourseRef, write_csv, write_jsonl
from course.grading.gradebook import Gradebook, Key, Result
from course.grading.intake import Entry, read_quiz, read_student, students
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.quiz import grade_quiz, quiz_version, record_sha256
from course.grading.session import grader_version
from course.quizzing.bank import Bank

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["RunOptions", "Summary", "Trouble", "export_all", "grade_class"]


@dataclass(frozen=True)
class RunOptions:
    """How a class is graded.

    Attributes:
        exercises: ids asked for by name, "quiz" among them; empty takes all, and then an exercise nobody
            handed in is no fault.
        only: students to grade; empty takes all.
        seed: seed of the run; None draws one, and a resumed run keeps its own.
    """

    exercises: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    graders: int = 1
    level: str | None = None
    at_least: str = "L2"
    timeout: float = 10.0
    seed: int | None = None
    resume: bool = False


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
        elapsed_s: wall seconds.
    """

    states: Counter[str] = field(default_factory=Counter)
    passed: int = 0
    troubled: list[Trouble] = field(default_factory=list)
    not_submitted: int = 0
    already: int = 0
    levels: Counter[str] = field(default_factory=Counter)
    seed: int = 0
    elapsed_s: float = 0.0

    @property
    def exit_code(self) -> int:
        """70 if any fault was ours, 6 if anything could not be graded, else 0 whatever the scores."""
        return 70 if self.states["grader_error"] else 6 if self.states["ungradable"] else 0

    def count(self, result: Result) -> None:
        verdict = result.verdict
        self.states[verdict.state] += 1
        self.passed += verdict.passed
        if verdict.isolation:
            self.levels[verdict.isolation] += 1
        if verdict.error is not None:
            key, error = result.key, verdict.error
            self.troubled.append(Trouble(key.student, key.exercise, verdict.state, error.code, error.message))


def grade_class(
    folder: Path,
    out: Path,
    catalog: Catalog,
    options: RunOptions,
    report: Callable[[Result, int, int], None],
) -> Summary:
    """Grade every submission below ``folder`` into ``out``.

    Args:
        report: called with each new result, how many students are done, and how many there are.

    Raises:
        MissingCapabilityError: there are no hidden graders here, or no sufficient protection.
        NotFoundError: no such folder, exercise or student.
        UsageError: ``out`` exists, or lies among the submissions.
    """
    if catalog.content.graders is None:
        raise MissingCapabilityError(
            "This installation has no hidden graders: it is a student's.",
            help="Grade from a checkout of the course.",
            code="needs_checkout",
        )
    exercises = _exercises(catalog, options.exercises)
    class_list = _class_list(folder, options.only)
    started = time.monotonic()
    with _open(out, folder, options) as book:
        seed = _seed(book, options)
        versions = {exercise.id: grader_version(exercise, catalog) for exercise in exercises}
        book.set_meta(seed=str(seed), course=catalog.course_id, version=catalog.version)
        summary = Summary(seed=seed)
        counter = _Counter(len(class_list))
        entries = _left_to_do(class_list, exercises, options, book, versions, summary, counter)
        batch = BatchOptions(options.graders, options.level, options.at_least, options.timeout, seed)
        for graded in grade_all(entries, batch):
            entry = graded.entry
            key = Key(entry.student, entry.exercise.id, entry.sha256, versions[entry.exercise.id], seed)
            result = Result(key, graded.verdict)
            book.add(result)
            report(result, counter.done, counter.total)
        if not options.exercises or QUIZ in options.exercises:
            for result in _quizzes(class_list, catalog, options, book, summary):
                book.add(result)
                report(result, counter.total, counter.total)
        book.flush()
        for result in book.results():
            summary.count(result)
        export_all(out, book, CourseRef(catalog.course_id, catalog.version))
    summary.elapsed_s = time.monotonic() - started
    return summary


def _quizzes(
    class_list: list[tuple[str, Path]],
    catalog: Catalog,
    options: RunOptions,
    book: Gradebook,
    summary: Summary,
) -> Iterator[Result]:
    """The quiz attempts that came with the submissions, scored here: no student's code is involved."""
    bank = Bank(read_questions(catalog.content.quiz))
    version = quiz_version(bank)
    for student, path in class_list if bank.ids else ():
        try:
            record = read_quiz(path)
        except UngradableError as error:
            record = error.code  # no list of attempts, which the scoring says of it
        verdict = grade_quiz(bank, record)
        if verdict is None:
            continue
        key = Key(student, QUIZ, record_sha256(record), version, summary.seed)
        if options.resume and book.has(key):
            summary.already += 1
        else:
            yield Result(key, verdict)


def export_all(out: Path, book: Gradebook, course: CourseRef) -> None:
    """The files that lie beside a gradebook after every run."""
    write_jsonl(out / "results.jsonl", book.results(), course)
    write_csv(out / "grades.csv", book.results())


class _Counter:
    """How many students were reached."""

    def __init__(self, total: int) -> None:
        self.total = total
        self.done = 0


def _left_to_do(
    class_list: list[tuple[str, Path]],
    exercises: Sequence[Exercise],
    options: RunOptions,
    book: Gradebook,
    versions: dict[str, str],
    summary: Summary,
    counter: _Counter,
) -> Iterator[Entry]:
    for student, path in class_list:
        for entry in read_student(student, path, exercises, required=bool(options.exercises)):
            if entry.submission is None and entry.problem is None:
                summary.not_submitted += 1
                continue
            key = Key(student, entry.exercise.id, entry.sha256, versions[entry.exercise.id], summary.seed)
            if options.resume and book.has(key):
                summary.already += 1
                continue
            yield entry
        counter.done += 1


def _exercises(catalog: Catalog, wanted: tuple[str, ...]) -> tuple[Exercise, ...]:
    if not wanted:
        return catalog.exercises()
    return tuple(catalog.exercise(name) for name in dict.fromkeys(wanted) if name != QUIZ)


def _class_list(folder: Path, only: tuple[str, ...]) -> list[tuple[str, Path]]:
    everyone = students(folder)
    if not only:
        return everyone
    unknown = sorted(set(only) - {name for name, _ in everyone})
    if unknown:
        raise UsageError(
            f"{folder} has no student {unknown[0]!r}.",
            help="--only takes the name of a student's folder.",
            code="student_not_found",
        )
    return [(name, path) for name, path in everyone if name in only]


def _open(out: Path, folder: Path, options: RunOptions) -> Gradebook:
    if out.resolve().is_relative_to(folder.resolve()):
        raise UsageError(
            f"--out {out} lies among the submissions.",
            help="Name a folder elsewhere.",
            code="out_inside_submissions",
        )
    path = out / "gradebook.sqlite"
    if not options.resume or not path.exists():
        # Killed before its gradebook was made, a run leaves the folder and perhaps the draft.
        begun = (
            options.resume
            and out.is_dir()
            and all(item.name.startswith("gradebook.new") for item in out.iterdir())
        )
        if out.exists() and not begun:
            raise UsageError(
                f"{out} exists already; nothing was touched.",
                help="Name a new folder, or add --resume to finish the run that is there.",
                code="out_exists",
            )
        try:
            out.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(
                f"{out} cannot be made: {error.strerror}.", help="Name a folder that can be written."
            ) from None
        return Gradebook(path, create=True, writing=True)
    return Gradebook(path, writing=True)


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

"""A grading run from folder to gradebook: what ``course grade run`` does, without the words."""

import contextlib
import os
import secrets
import time
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.questions import read_questions
from course.catalog.reading import refuse_blanks
from course.errors import ContentError, UngradableError, UsageError
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import GradedExercise, Key, PlatformIdentity, Result, SubmittedAt
from course.grading.gradebook.salvage import back_up
from course.grading.intake.archives import RefusedError
from course.grading.intake.downloads import ClassList, Student, class_list
from course.grading.intake.students import Entry, read_quiz, read_student, submission_from, witnesses
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.quiz import grade_quiz, quiz_version, record_sha256
from course.grading.results.effective import (
    Effective,
    Results,
    ScoreChange,
    Scores,
    counted_in,
    counting,
    replacing,
)
from course.grading.results.roster import Roster, spelled
from course.grading.running import folder as runs
from course.grading.running.batch import Graded, grade_all
from course.grading.running.snapshot import Snapshot, Unpacked, among_graders, fresh, frozen, kept
from course.printable import one_line
from course.quizzing.bank import Bank, needed
from course.scoring.graders import grader_version
from course.scoring.judging.submission import Terms
from course.scoring.verdict import OURS, Problem, format_points

GradeAll = Callable[[Iterable[Entry], Terms], Iterator[Graded]]


# ---
# A grading run in numbers.


class Ungraded(msgspec.Struct, frozen=True):
    student: str
    exercise: str
    state: str
    code: str
    message: str


@dataclass
class Summary:
    """The numbers of a run.

    Attributes:
        troubled: the results without a grade.
        not_submitted: pairs without a file, which count for nothing.
        already: results of an earlier run.
        stay: of these, those whose file is gone, or is assigned and has changed; a sentence each.
        lower: scores that are lower than before a resumed run, a sentence each.
        untimed: "student exercise" of new work without a trusted time, where the earlier work had one.
        missing: students who handed in nothing at all: enrolled, or without a roster those with a folder.
        strangers: students who handed in something and have no row of their own in the roster.
        compared: the columns of the roster in which these were looked for, as sentences.
        unrecognised: files in the class folder with an unknown owner, one sentence each.
        dropped: students of the earlier roster that it does not have.
        unjudged: checks whose own code broke on a submission, a sentence each.
        pass_marks: of the exercises with results: the points that pass, and all points.
        scores: of the exercises with grades: those that count.
        unsettled: entries that could not be graded and have no score by hand.
        elsewhere: graded submissions without functions that another file has, a sentence each.
        edited: exercises scored by other graders than the present ones: a resumed run keeps its own.
        write_s: of the seconds, those spent on writing the gradebook.
    """

    states: Counter[str] = field(default_factory=Counter)
    passed: int = 0
    troubled: list[Ungraded] = field(default_factory=list)
    not_submitted: int = 0
    missing: list[str] = field(default_factory=list)
    strangers: list[str] = field(default_factory=list)
    compared: str = ""
    already: int = 0
    stay: list[str] = field(default_factory=list)
    lower: list[str] = field(default_factory=list)
    untimed: list[str] = field(default_factory=list)
    levels: Counter[str] = field(default_factory=Counter)
    unrecognised: list[str] = field(default_factory=list)
    moved: list[ScoreChange] = field(default_factory=list)
    dropped: list[str] = field(default_factory=list)
    unjudged: tuple[str, ...] = ()
    graders: str = ""
    pass_marks: list[tuple[float, float]] = field(default_factory=list)
    scores: dict[str, list[float]] = field(default_factory=dict)
    unsettled: int = 0
    elsewhere: list[str] = field(default_factory=list)
    edited: list[str] = field(default_factory=list)
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
        there = set(results.book.exercise_ids())
        graded = [item for item in results.exercises() if item.id in there]
        self.pass_marks = [(item.pass_share * item.max_points, item.max_points) for item in graded]
        self.scores = {item.id: [] for item in graded}
        waiting = {effective.student for effective in results.all() if effective.waiting}
        known = (name for name in results.absent() if name not in waiting)
        looked = results.looked or ()
        self.missing = [name for name in known if all(results.has_looked(name, id_) for id_ in looked)]
        self.strangers = results.unmatched(results.students())
        if results.roster is not None and self.strangers:
            self.compared = results.roster.compared(self.strangers, results.downloads)
        broken: list[tuple[str, str, str]] = []
        for effective in results.all():
            verdict = effective.verdict
            if effective.missing or effective.waiting:
                continue
            settled = effective.override is not None  # a score by hand counts, even without a grading
            self.states["graded" if settled else verdict.state] += 1
            self.passed += effective.passed
            if effective.score is not None and (settled or verdict.state == "graded"):
                self.scores.setdefault(effective.exercise, []).append(effective.score)
            self.unsettled += effective.unsettled
            if effective.elsewhere:
                self.elsewhere.append(f"{effective.student} {effective.exercise}: {effective.elsewhere}")
            if verdict.isolation:
                self.levels[verdict.isolation] += 1
            broken += broken_checks(effective)
            if verdict.error is not None and not settled:
                self.troubled.append(ungraded(effective, verdict.error))
        self.unjudged = unjudged(broken)


def ungraded(result: Effective, error: Problem) -> Ungraded:
    return Ungraded(result.student, result.exercise, result.verdict.state, error.code, error.message)


def broken_checks(result: Effective) -> list[tuple[str, str, str]]:
    """The checks whose own code broke on a submission: exercise, check, and where."""
    told = ((result.exercise, check.id, check.traceback or "") for check in result.verdict.checks)
    return [one for one in told if one[-1].startswith(OURS)]


def unjudged(broken: Iterable[tuple[str, str, str]]) -> tuple[str, ...]:
    """A sentence about each of these checks, the most frequent first."""
    found = Counter(broken).most_common()
    return tuple(f"{task} {check}, {count} of the results: {where}" for (task, check, where), count in found)


#: The name of a quiz record among the submissions in a gradebook.
QUIZ_RECORD = "quiz.json"
_TIMES_AT_ONCE = 256


@dataclass(frozen=True)
class RunOptions:
    """How a class is graded.

    Attributes:
        exercises: ids asked for by name, "quiz" among them; empty takes all, and then an exercise that no
            student handed in is no fault.
        only: students to grade; empty takes all.
        terms: protection and deadline; their seed is ignored.
        seed: of the run; None draws one, and a resumed run keeps its own.
        layout: what kind of folder it is; "auto" finds out.
        roster: who is enrolled, merged into the gradebook's own; None keeps that.
        accepted: digest of graders in the gradebook that may run though they are not this checkout's.
    """

    exercises: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    terms: Terms = Terms(at_least="L2")  # noqa: RUF009 - it cannot change
    seed: int | None = None
    resume: bool = False
    layout: str = "auto"
    roster: Roster | None = None
    accepted: str = ""


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
        grade: turns entries into verdicts; it gets only the work that is left, and this process remains the
            only one that writes.

    Raises:
        MissingCapabilityError: there are no hidden graders here, no sufficient protection, or no room.
        NotFoundError: no such folder, exercise or student.
        UsageError: ``out`` exists, is in use, lies among the submissions, or has somebody else's graders.
    """
    catalog.content.instructors()
    _exercises(catalog, options.exercises)
    members = _members(folder, options)
    if among_graders(folder, catalog.content):
        message = f"{folder} lies among the course's own exercises and graders."
        advice = "Move the submissions elsewhere: what lies there is kept and run as part of the graders."
        raise UsageError(message, help=advice, code="submissions_among_graders")
    started = time.monotonic()
    with (
        runs.taken_back(out) as taken,
        runs.begin(out, folder, resume=options.resume) as book,
        frozen(_graders(book, options, catalog), options.exercises or None) as graders,
    ):
        before = counting(Results(book)) if options.resume else {}
        run = _Run(members, graders, folder, options, book)
        if options.resume and (out / "grades.csv").is_file():
            runs.export_all(
                out, Results(book)
            )  # what lies there says of work that came since that there is none
        for result, files in run.results(grade):
            with run.replacing(result.key):
                graded = book.add(result, files)
            taken.graded |= bool(result.verdict.isolation)
            run.one_less(result.key.student)
            report(run.view.of(graded), run.done, len(run.names))
        run.note_times()
        runs.note_unread(book, run.unread)
        summary = run.summary
        if not options.only:
            summary.unrecognised = members.unrecognised
            book.set_meta(unrecognised=msgspec.json.encode(members.unrecognised).decode())
        runs.note_without_work(book, run.names)
        results = Results(book, run.roster)
        summary.count(results)
        if options.resume:
            summary.edited = edited_since(results, catalog)
            summary.lower = list(_lower(before, counting(results)))
        runs.export_all(out, results)
        summary.write_s = book.write_s
    back_up(out / runs.BOOK)
    summary.elapsed_s = time.monotonic() - started
    return summary


def _lower(before: Scores, now: Scores) -> Iterator[str]:
    """Scores that a resumed run made lower, by what was handed in for it."""
    for (student, exercise), (score, _) in before.items():
        # Nothing is lost; who has another name now has the score under that.
        after, _ = now.get((student, exercise), (score, None))
        if score is not None and (after is None or after < score):
            now_points = "no score" if after is None else format_points(after)
            yield f"{student} {exercise}: {format_points(score)} before, {now_points} now"


def _graders(book: Gradebook, options: RunOptions, catalog: Catalog) -> Snapshot:
    """The graders of a resumed run; of a new one, or one of an older format, those of now."""
    sha256 = book.run_options().get("snapshot") if options.resume else None
    return kept(book, sha256, catalog.content, options.accepted) or fresh(catalog.content)


def edited_since(results: Results, catalog: Catalog) -> list[str]:
    """Exercises with results that were scored by other graders than the present ones."""
    known = {*catalog.exercise_ids(), *catalog.warm_up_ids()} & {*results.book.exercise_ids()}
    now = {name: grader_version(catalog.exercise(name), catalog) for name in known}
    found = {
        item.exercise: None
        for item in results.all()
        if item.verdict.isolation and now.get(item.exercise) != item.result.key.grader_version
    }
    return list(found)


class _Run:
    """One run over a class, with a gradebook to write to."""

    def __init__(
        self, members: ClassList, graders: Unpacked, folder: Path, options: RunOptions, book: Gradebook
    ) -> None:
        known = as_known(members, book)
        both = zip(members.students, known, strict=True)
        asked = {*map(spelled, options.only)}
        self._students = [
            one for was, one in both if not asked or asked & {spelled(was.name), spelled(one.name)}
        ]
        self.names = {one.name for one in self._students}
        self._left_aside = {one.name for one in known} - self.names
        self.unread: set[tuple[str, str]] = set()
        self._graders = graders
        self._catalog = graders.catalog
        self._exercises = _exercises(self._catalog, options.exercises)
        asked_for = {exercise.id for exercise in self._exercises}
        self._others = [one for one in self._catalog.every_task() if one.id not in asked_for]
        self._folder = folder
        self._options = options
        self._book = book
        self._versions = {exercise.id: graders.version(exercise.id) for exercise in self._exercises}
        self._times: list[SubmittedAt] = []
        with_quiz = not options.exercises or QUIZ in options.exercises
        self._bank = _bank(self._catalog) if with_quiz else Bank(())
        self._with_quiz = bool(self._bank.ids)
        self._quiz_known = QUIZ in (book.looked() or {})
        self._quiz_version = quiz_version(self._bank)
        self.summary = Summary(seed=_seed(book, options), graders=graders.snapshot.sha256)
        self.roster: Roster | None = None
        self.done = 0
        self._open: Counter[str] = Counter()
        self._scored: deque[tuple[Result, dict[str, bytes]]] = deque()
        _check_assignment(members, book, out=book.path.parent)
        self._found = set(book.found())
        self._assigned = assigned_in(book)
        before, looked = book.waiting(), book.looked()
        self._note_facts()
        self.view = Results(book)
        # What was missing till now, and not only unread, is told when it comes.
        self.view.waiting, self.view.looked = before, looked

    def _note_facts(self) -> None:
        options, book = self._options, self._book
        course = self._catalog
        book.set_meta(
            seed=str(self.summary.seed), course=course.course_id, version=course.version,
            folder=one_line(str(self._folder.absolute())), layout=options.layout,
        )  # fmt: skip
        terms = options.terms
        facts = {
            "level": terms.level, "at_least": terms.at_least, "timeout": terms.timeout,
            "snapshot": self.summary.graders,
        }  # fmt: skip
        if not (options.resume and book.run_options().get("snapshot")):
            book.keep_snapshot(self.summary.graders, self._graders.snapshot.packed)
            book.begin_run("run", facts)
        asked = [*self._versions, *([QUIZ] if self._with_quiz else [])]
        runs.note_looked(book, asked, self.names, self._left_aside, named=bool(options.exercises))
        book.set_exercises(graded_exercises(self._exercises, self._bank if self._with_quiz else None))
        book.set_students({who.name: who.identity for who in self._students if who.identity is not None})
        # Before a roster says who is enrolled: until their work is looked at, nobody handed in nothing.
        book.set_waiting(sorted(self.names), others=bool(options.only))
        if options.roster is not None:
            found = runs.remember(book, options.roster)
            self.roster, self.summary.moved, self.summary.dropped = found.roster, found.moved, found.dropped

    def results(self, grade: GradeAll) -> Iterator[tuple[Result, dict[str, bytes] | None]]:
        """Grade the work that is left; each verdict comes with its submission."""
        terms = msgspec.structs.replace(
            self._options.terms, seed=self.summary.seed, graders=self.summary.graders
        )
        for graded in grade(self._left_to_do(), terms):
            yield from self._quizzes()
            entry, submission = graded.entry, graded.entry.submission
            result = Result(self._key(entry, graded.version), entry.told(graded.verdict))
            yield result, dict(submission.files) if submission else None
        yield from self._quizzes()

    def _key(self, entry: Entry, judged_by: str = "") -> Key:
        version = judged_by or self._versions[entry.exercise.id]
        return Key(entry.student, entry.exercise.id, entry.sha256, version, self.summary.seed)

    def _left_to_do(self) -> Iterator[Entry]:
        for student in self._students:
            self._open[student.name] += 1
            # First: what is handed in with it may take all the time for reading.
            if self._with_quiz or self._quiz_known:
                self._score_quiz(student)
            required = bool(self._options.exercises)
            for entry in read_student(student, self._exercises, required=required, others=self._others):
                if entry.unread:
                    self.unread.add((student.name, entry.exercise.id))
                if entry.unread or self._stays(entry):
                    continue
                if entry.submission is None and entry.problem is None:
                    self.summary.not_submitted += 1
                    continue
                self._witnessed(entry.times)
                self._note_found(entry)
                if self._options.resume and (self._is_replaced(entry) or self._confirmed(self._key(entry))):
                    self.summary.already += 1
                    self._note_changed(entry)
                    if entry.submission is not None:
                        self._book.restore(entry.sha256, entry.submission.files)
                    continue
                self._open[student.name] += 1
                yield entry
            self.one_less(student.name)

    def _stays(self, entry: Entry) -> bool:
        """Whether what was graded is not there any more: a lack takes the place of no result."""
        about = entry.student, entry.exercise.id
        absent = entry.submission is None and (entry.problem is None or entry.problem.code == "no_file")
        if not (self._options.resume and absent) or about in self._assigned:
            return False
        counts = next(self._book.results(*about), None)
        if counts is None or counts.key.submission_sha256 == entry.sha256:
            return False
        said = entry.problem.message if entry.problem else f"There is no {entry.exercise.module} any more."
        self.summary.stay.append(f"{' '.join(about)}: {said}")
        self.summary.already += 1
        return True

    def _is_replaced(self, entry: Entry) -> bool:
        """Whether an instructor has assigned a file since this work, or its lack, was there."""
        about = entry.student, entry.exercise.id
        if entry.submission is None or about not in self._assigned:
            return about in self._assigned
        before, assigned, _ = self._assigned[about]
        counts = next(self._book.results(*about), None) if before == entry.sha256 else None
        return counts is not None and counts.key.submission_sha256 == assigned

    def _note_changed(self, entry: Entry) -> None:
        """Say of an assigned file that it is not what was graded any more; if it is, it may be lost."""
        about = entry.student, entry.exercise.id
        _, assigned, file = self._assigned.get(about, ("", "", ""))
        for one in entry.found.candidates if entry.found and file else ():
            path = Path(os.fsdecode(one.path))
            if one.name == file or (not one.member and Path(file).resolve() == path.resolve()):
                with contextlib.suppress(RefusedError):
                    now = submission_from(entry.exercise, path, one.member)
                    if now.sha256 == assigned:
                        self._book.restore(assigned, now.files)
                        return
                self.summary.stay.append(
                    f"{' '.join(about)}: {one.name} has changed since it was assigned. Assign it again to"
                    " grade it as it is now."
                )
                return

    def _confirmed(self, key: Key) -> bool:
        return self._book.confirm(key, self.replacing(key))

    def replacing(self, key: Key) -> AbstractContextManager[None]:
        """Where a result takes the place of another: only a resumed run finds one."""
        if not self._options.resume:
            return contextlib.nullcontext()
        return replacing(self._book, self.view, key, self.summary.untimed)

    def _note_found(self, entry: Entry) -> None:
        about = (entry.student, entry.exercise.id)
        if self._is_replaced(entry):
            return
        if entry.found is not None:
            self._book.set_found(*about, msgspec.json.encode(entry.found).decode())
            self._found.add(about)
        elif about in self._found:
            self._book.set_found(*about, None)

    def one_less(self, student: str) -> None:
        """A student is done when all of their files are read and all that was read is graded."""
        self._open[student] -= 1
        if not self._open[student]:
            del self._open[student]
            self.done += 1
            self._book.settle(student)

    def _quizzes(self) -> Iterator[tuple[Result, dict[str, bytes]]]:
        """The quizzes that were scored meanwhile."""
        while self._scored:
            yield self._scored.popleft()

    def _score_quiz(self, student: Student) -> None:
        """Score the quiz attempts that came with a submission; no student's code is involved."""
        path = None
        try:
            record, path = read_quiz(student, alone=not self._exercises or QUIZ in self._options.exercises)
        except UngradableError as error:
            record = error.message.rstrip(".")  # no list of attempts, which the scoring says of it
        if not self._with_quiz:
            self.unread |= {(student.name, QUIZ)} if record else set()
            return
        verdict = grade_quiz(self._bank, record)
        if verdict is None:
            return
        key = Key(student.name, QUIZ, record_sha256(record), self._quiz_version, self.summary.seed)
        self._witnessed(witnesses(student, QUIZ, key.submission_sha256, path))
        if self._options.resume and self._confirmed(key):
            self.summary.already += 1
            self._book.restore(key.submission_sha256, {QUIZ_RECORD: _as_json(record)})
            return
        self._open[student.name] += 1
        self._scored.append((Result(key, verdict), {QUIZ_RECORD: _as_json(record)}))

    def _witnessed(self, times: tuple[SubmittedAt, ...]) -> None:
        self._times += times
        if self.view.policy is not None:
            self.view.take_in(times)
        if len(self._times) >= _TIMES_AT_ONCE:
            self.note_times()

    def note_times(self) -> None:
        """Put all known times of submission into the gradebook."""
        if self._times:
            self._book.add_times(self._times)
        self._times.clear()


def assigned_in(book: Gradebook) -> dict[tuple[str, str], tuple[str, str, str]]:
    """The submission that an assigned file took the place of, and the file with its name, by student and
    exercise; none that was taken back."""
    found: dict[tuple[str, str], tuple[str, str, str]] = {}
    for one in book.journal():
        if one.kind == "assign":
            about, before = (one.student, one.exercise), counted_in(one.before).submission
            first, last, _ = found.get(about, (before, before, ""))  # a second one replaces the first
            now = counted_in(one.after)
            if not now.file:
                found.pop(about, None)
                continue
            found[about] = (first if last == before else before), now.submission, now.file
    return found


def _bank(catalog: Catalog) -> Bank:
    try:
        return Bank(read_questions(catalog.content.quiz))
    except ContentError as error:
        raise _unfinished("The quiz", error, catalog, "the quiz") from None


def _unfinished(what: str, error: ContentError, catalog: Catalog, without: str) -> UsageError:
    """A file of the course that nothing can be graded with, by the name that its author knows."""
    where = catalog.content.shown(error.file) + (f":{error.line}" if error.line else "")
    return UsageError(
        f"{what} cannot be graded: {where}: {error.problem}",
        help="Finish it (`course author check` says what is left), or name what to grade without "
        f"{without} with --exercise.",
        code="unfinished_content",
    )


def _as_json(record: object) -> bytes:
    with contextlib.suppress(TypeError, ValueError, RecursionError, msgspec.MsgspecError):
        return msgspec.json.encode(record)
    return b"null"  # what cannot be written again was ungradable, and stays so


def graded_exercises(exercises: Sequence[Exercise], bank: Bank | None) -> list[GradedExercise]:
    """A gradebook's notes on the exercises, and on the quiz if there is one."""
    noted = [
        GradedExercise(item.id, item.title, item.max_points, item.pass_mark, item.order) for item in exercises
    ]
    if bank is not None:
        total = len(bank.ids)
        noted.append(GradedExercise(QUIZ, "Quiz", float(total), needed(total) / total, 1_000_000))
    return noted


def _exercises(catalog: Catalog, wanted: tuple[str, ...]) -> tuple[Exercise, ...]:
    chosen = catalog.exercises() if not wanted else ()
    chosen += tuple(catalog.exercise(name) for name in dict.fromkeys(wanted) if name != QUIZ)
    for exercise in chosen:
        hidden = catalog.content.instructors()[1] / exercise.place / "checks.py"
        try:
            for path in (exercise.checks_path.with_name("exercise.toml"), exercise.checks_path, hidden):
                if path.is_file():
                    refuse_blanks(path)
        except ContentError as error:
            raise _unfinished(f"Exercise {exercise.id}", error, catalog, "it") from None
    return chosen


def as_known(members: ClassList, book: Gradebook) -> list[Student]:
    """The students of a class folder, each by the name that the gradebook has for them.

    A platform's number is one student's, whatever comes with it: a surname changes, and student ids are
    entered later. A Mac spells accents otherwise.
    """
    called = book.students()
    there = {*called, *book.student_ids(), *book.without_work()}
    names: dict[object, set[str]] = {}
    for name in there:
        for one in _marks(name, called.get(name)):
            names.setdefault(one, set()).add(name)
    taken = {student.name for student in members.students}
    found = []
    for student in members.students:
        if student.name not in there:
            marks = _marks(student.name, student.identity)
            mine = next((names[one] for one in marks if one in names), set())
            name = min(mine, default=student.name)
            if len(mine) == 1 and name not in taken and not _differs(student.identity, called.get(name)):
                taken.add(name)
                student = replace(student, name=name)  # noqa: PLW2901 - the same one
        found.append(student)
    return found


def _marks(name: str, who: PlatformIdentity | None) -> list[object]:
    """What tells a student apart, the surest first."""
    if who is None:
        return [("", spelled(name))]
    keys = (who.sid, who.email.casefold()) if who.source == "gradescope" else (who.key,)
    return [(who.source, column, key) for column, key in enumerate(keys) if key]


def _differs(one: PlatformIdentity | None, other: PlatformIdentity | None) -> bool:
    """Whether two students of Gradescope's have an address in common, and ids of their own."""
    return bool(one and other and one.sid and other.sid and one.sid != other.sid)


def _check_assignment(members: ClassList, book: Gradebook, out: Path) -> None:
    """Refuse the download of a second assignment of Moodle's, which would double the class: Moodle gives each
    student another number in each, and folders are called after it."""
    known = {one.key: name for name, one in book.students().items() if one.source == "moodle"}
    called = {one.name: known[one.key] for one in book.students().values() if one.source == "moodle"}
    new = {who.name: one for who in members.students if (one := who.identity) and one.source == "moodle"}
    again = [(called[one.name], name) for name, one in new.items() if one.name in called]
    if again and not any(one.key in known for one in new.values()):
        was, now = again[0]
        raise UsageError(
            f"This is another assignment of Moodle's than the one in {out}: there {one_line(was)} has another"
            f" number ({one_line(now)} here), and the class would be in it twice. Nothing was changed.",
            help="Grade each assignment of Moodle's into a folder of its own: --out ANOTHER.",
            code="other_assignment",
        )


def _members(folder: Path, options: RunOptions) -> ClassList:
    found = class_list(folder, options.layout)
    if options.only:
        there = {spelled(student.name) for student in found.students}
        if unknown := [name for name in options.only if spelled(name) not in there]:
            message = f"{folder} has no student {unknown[0]!r}."
            advice = "--only takes the name of a student's folder."
            raise UsageError(message, help=advice, code="student_not_found")
    return found


def _seed(book: Gradebook, options: RunOptions) -> int:
    if "seed" not in book.meta():
        return options.seed if options.seed is not None else secrets.randbits(31)
    recorded = Results(book).seed
    if options.seed not in (None, recorded):
        advice = "Leave --seed out to go on, or grade into a new folder."
        raise UsageError(f"This gradebook was begun with --seed {recorded}.", help=advice, code="other_seed")
    return recorded

"""The scores of a class that count: the only reader of a gradebook.

A gradebook keeps the graders' results, the instructor's decisions and the late policy apart. ``Results``
combines them, in the same way for every export and report. The newest grading of each student and exercise
counts, less the penalty for lateness; an override replaces it and is final, whatever the lateness. A fault of
ours is never a zero: its score is None until it is graded or overridden. Enrolled students who handed in
nothing, or without a roster those whose folder held no work, have a result too: ``missing``, without a score;
an option decides how an export writes it. Until a run has looked at all of a student's work, nothing is
``missing``: it is ``not_graded_yet``, and no platform is told anything.
"""

import contextlib
import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import msgspec

from course.catalog.models import CourseRef
from course.errors import NotFoundError, UsageError
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.file import explained
from course.grading.gradebook.records import (
    ELSEWHERE,
    Decision,
    GradedExercise,
    Key,
    Looked,
    Override,
    Result,
    SubmittedAt,
)
from course.grading.results.late import Policy, lateness, may_change, parse_policy
from course.grading.results.roster import FOR_TESTS, Person, Roster, spelled
from course.printable import command, one_line, quoted, some
from course.scoring.verdict import Problem, Verdict, format_points, not_graded

#: State of work that an enrolled student did not hand in.
MISSING = "missing"
#: State of work that a run has not looked at: whether there is any is not known.
NOT_YET = "not_graded_yet"
_NOTHING = {
    MISSING: Problem("not_submitted", "Nothing was handed in."),
    NOT_YET: Problem(
        "not_graded_yet",
        "No run has looked at all of this student's work yet.",
        "`course grade run` with --resume, for this exercise and without --only, does.",
    ),
}
_NOBODY = Looked()
#: The shortest day that a clock has, in seconds.
_ALMOST_A_DAY = 82_800.0
_WITHOUT_SCORE = frozenset({"grader_error", MISSING, NOT_YET})


@dataclass(frozen=True)
class Effective:
    """The effective result of one student and exercise.

    Attributes:
        result: the newest grading, with its verdict.
        score: in points; None if it is missing or not graded yet, or if a fault of ours kept it from being
            graded.
        passed: whether ``score`` reaches the exercise's pass mark.
        penalty: points taken off for lateness; 0 under an override.
        late: seconds after the deadline; None if in time, or if the time is not known.
        submitted_at: seconds since 1970, UTC, by the most trusted witness; None if there is none.
        witness: the source of that time.
        flagged_late: the download says "late" but not by how much.
    """

    result: Result
    score: float | None
    max_score: float
    passed: bool
    penalty: float = 0.0
    late: float | None = None
    submitted_at: float | None = None
    witness: str = ""
    flagged_late: bool = False
    override: Override | None = None

    @property
    def student(self) -> str:
        return self.result.key.student

    @property
    def exercise(self) -> str:
        return self.result.key.exercise

    @property
    def verdict(self) -> Verdict:
        return self.result.verdict

    @property
    def seconds(self) -> float:
        """Wall time of its checks, in s."""
        return sum(check.duration_ms for check in self.verdict.checks) / 1e3

    @property
    def missing(self) -> bool:
        """Whether an enrolled student handed in nothing, and no decision was made about it."""
        return self.verdict.state == MISSING and self.override is None

    @property
    def waiting(self) -> bool:
        """Whether no run has looked for it yet, and no decision was made about it."""
        return self.verdict.state == NOT_YET and self.override is None

    @property
    def unsettled(self) -> bool:
        """Whether it is a zero that no instructor has decided on: not gradable, and no score by hand."""
        return self.verdict.state == "ungradable" and self.override is None

    @property
    def elsewhere(self) -> str:
        """The functions that are written only in a file that was not graded, and in which; empty if there are
        none, or if no point is lost or a score by hand counts."""
        if self.override is not None or self.verdict.score >= self.max_score:
            return ""
        notes = (note for note in self.verdict.warnings if note.startswith(ELSEWHERE))
        return next(notes, "").removeprefix(ELSEWHERE).rstrip(".")

    @property
    def raw_score(self) -> float | None:
        """The checks' score, before lateness and overrides."""
        return None if self.verdict.state in _WITHOUT_SCORE else self.verdict.score


class Results:
    """The effective results in an open gradebook.

    Args:
        book: the gradebook; the caller closes it.
        roster: a class list; None takes the gradebook's own.

    Attributes:
        seed: of the run's hidden inputs.
        waiting: students whose work a run has still to look at.
        looked: by exercise, whose work was looked at; None if that was not noted.

    Raises:
        IntegrityError: its content was changed or damaged.
    """

    def __init__(self, book: Gradebook, roster: Roster | None = None) -> None:
        self.book = book
        self.folder = book.path.parent
        meta = book.meta()
        self.course = CourseRef(meta.get("course", ""), meta.get("version", ""))
        kept = f"The late policy in {book.path}"
        self.policy: Policy | None = (
            parse_policy(meta["late_policy"], kept) if "late_policy" in meta else None
        )
        with explained(book.path):
            self.seed = msgspec.json.decode(meta.get("seed", "0"), type=int)
            self.roster = roster or (Roster.load(meta["roster"]) if "roster" in meta else None)
        self._without_work = set(book.without_work())
        self.waiting = book.waiting()
        self.looked = book.looked()
        self.downloads = book.students()
        self._exercises = {exercise.id: exercise for exercise in book.exercises()}
        self._overrides: dict[tuple[str, str], Override] = {}
        for override in book.overrides():
            self._overrides[self._owner(override.student), override.exercise] = override
        self._times: dict[tuple[str, str], list[tuple[str, str, float | None]]] = {}
        self.take_in(book.times())

    def take_in(self, times: Iterable[SubmittedAt]) -> None:
        for time in times:
            place = self._times.setdefault((self._owner(time.student), time.exercise), [])
            place.append((time.submission_sha256, time.source, time.at))

    def tie_times(self, key: Key) -> None:
        """Keep the times of a list with the work that they were given for: later work has none of them."""
        mine = self._times.get((key.student, key.exercise), [])
        if any(not sha256 for sha256, _, _ in mine):
            for name in (key.student, *(name for name, at in self._arrived.items() if at == key.student)):
                self.book.tie_times(name, key)
            mine[:] = [(sha256 or key.submission_sha256, who, at) for sha256, who, at in mine]

    def _owner(self, name: str) -> str:
        """The student's name: what was decided under the roster's, before a folder came, is the folder's."""
        return name if name in self._with_folder else self._arrived.get(name, name)

    @cached_property
    def _with_folder(self) -> set[str]:
        return {*self.book.student_ids(), *self.waiting, *self._unread}

    @cached_property
    def _unread(self) -> set[str]:
        """Who came to a class that had been looked at, and was not."""
        return {name for one in (self.looked or {}).values() if one.whole for name in one.names}

    def has_looked(self, student: str, exercise: str) -> bool:
        """Whether a run looked for a student's work, or for the student's folder."""
        return self.looked is None or self.looked.get(exercise, _NOBODY).at(student)

    @cached_property
    def _arrived(self) -> dict[str, str]:
        found = self.roster.match(self._with_folder, self.downloads)[0] if self.roster else {}
        return {person.student: student for student, person in found.items()}

    def decisions(self, student: str | None, exercise: str | None) -> list[Decision]:
        """The journal about a student, with what was decided under the roster's name before a folder came."""
        person = self.person(student) if student is not None else None
        earlier = self.book.journal(person.student, exercise) if person and person.student != student else []
        return [one for one in earlier if one.student] + self.book.journal(student, exercise)

    def exercises(self) -> tuple[GradedExercise, ...]:
        return tuple(self._exercises.values())

    def students(self) -> list[str]:
        """All students with a result, an override, a row in the roster or a folder, by name."""
        return sorted({*self.present(), *self.absent()})

    def called(self, name: str) -> str:
        """The student who is called so: a name in the gradebook, or what the roster knows about one alone.

        Anything else is given back as it is, for whoever asks to refuse.

        Raises:
            NotFoundError: several students are called so.
        """
        students = self.students()
        if name in students:
            return name
        # A name with characters that no list of ours can show is spelled out in all of them.
        shown = [student for student in students if spelled(one_line(student)) == spelled(name)]
        if len(shown) == 1:
            return shown[0]
        if self.roster is None:
            people = {student: self.person(student) for student in students}
            so = [student for student, one in people.items() if one and name in {one.name, one.email}]
            return _only(so, name)
        meant = {person.student for person in self.roster.rows(name)}
        found = self.roster.match(self.present(), self.downloads)[0]
        ids = {student for student, person in found.items() if person.student in meant}
        ids |= meant & set(self.absent())
        return _only(sorted(ids), name)

    def named(self, student: str) -> str:
        """A student's name in the gradebook, and in brackets the one in the roster if that is another."""
        person = self.person(student)
        known = one_line(person.name) if person is not None and person.name != student else ""
        return one_line(student) + (f" ({known})" if known else "")

    def verify(self) -> None:
        """Read every row there is, so that a damaged gradebook answers nothing.

        Raises:
            IntegrityError: something is not what was written.
        """
        self.book.verify()
        for _ in self.all():
            pass

    def absent(self) -> list[str]:
        """The students without work: of the roster, in its order, or those whose folder held none."""
        known = self.present()
        if self.roster is None:
            return sorted(self._without_work - known)
        found, _ = self.roster.match(known, self.downloads)
        there = known | {person.student for person in found.values()}
        return [one.student for one in self.roster.people if one.student not in there]

    def present(self) -> set[str]:
        """The students with a result or an override, and those whose work waits."""
        by_hand = (name for name, _ in self._overrides)
        return {*self.book.student_ids(), *by_hand, *self.waiting, *self._unread}

    def title(self, exercise: str) -> str:
        """The exercise's title; its id where none was noted."""
        return self._exercises[exercise].title if exercise in self._exercises else exercise

    def person(self, student: str) -> Person | None:
        """The roster's row about a student, or, without a roster, what Gradescope's download says."""
        known = self.downloads.get(student)
        if self.roster is not None:
            return self.roster.find(student, known)
        said = known is not None and known.source == "gradescope"
        return Person(student, known.name, known.email, sis_user_id=known.sid) if known and said else None

    def all(self, student: str | None = None, exercise: str | None = None) -> Iterator[Effective]:
        """Every student and exercise, ordered by both; students without a grade come at the end."""
        enrolled, asked = self._enrolled, self._asked
        done: set[tuple[str, str]] = set()
        for name, group in itertools.groupby(self.book.results(student, exercise), lambda r: r.key.student):
            for result in group:
                done.add((name, result.key.exercise))
                yield self.of(result)
            yield from self._without_grading(name, exercise, done, asked if name in enrolled else frozenset())
        named = {name for name, _ in self._overrides} | enrolled | self.waiting
        for name in sorted(named) if student is None else [student]:
            yield from self._without_grading(name, exercise, done, asked if name in enrolled else frozenset())

    @cached_property
    def _enrolled(self) -> set[str]:
        """The students with a row of the roster, absent or not; without a roster only the absent ones.

        Found once: one student's results are asked for as often as there are students.
        """
        if self.roster is None:
            return set(self.absent())
        return {*self.absent(), *self.roster.match(self.present(), self.downloads)[0]}

    @cached_property
    def _asked(self) -> frozenset[str]:
        """The exercises that can be missing: one that no student handed in, and nobody named, was not set."""
        if not self._enrolled or self.looked is None:
            return frozenset(self.book.exercise_ids() if self._enrolled else ())
        named = (name for name, looked in self.looked.items() if looked.named)
        return frozenset((*self.book.exercise_ids(handed_in=True), *named))

    def _without_grading(
        self, student: str, exercise: str | None, done: set[tuple[str, str]], asked: frozenset[str]
    ) -> Iterator[Effective]:
        """The results for work that no grader saw: by hand, waiting, or missing if it was asked for."""
        waits = student in self.waiting
        for about in self._exercises if exercise is None else [exercise]:
            override = self._overrides.get((student, about))
            by_hand = override is not None and override.score is not None
            may_wait = waits and about in self._exercises
            if (student, about) not in done and (by_hand or may_wait or about in asked):
                done.add((student, about))
                known = by_hand or (not waits and self.has_looked(student, about))
                yield self.of(self.nothing(student, about, MISSING if known else NOT_YET))

    def of(self, result: Result) -> Effective:
        """The effective result for a grading."""
        verdict, key = result.verdict, result.key
        noted = self._exercises.get(key.exercise)
        most = verdict.max_score if noted is None or verdict.state == "graded" else noted.max_points
        submitted, witness = self._submitted(key)
        due = self._due(key)
        late = None if due is None or submitted is None else lateness(submitted, due)
        override = self._overrides.get((key.student, key.exercise))
        if override is not None and override.score is None:
            override = None
        penalty = 0.0
        if override is not None:
            score = override.score
        elif verdict.state in _WITHOUT_SCORE:
            score = None
        else:
            if self.policy is not None and due is not None and verdict.state == "graded":
                penalty = self.policy.penalty(late, verdict.score, most, due)
            score = verdict.score - penalty
        return Effective(
            result, score, most, self._passes(result, score, most), penalty, late, submitted, witness,
            submitted is None and "canvas-late" in dict(self._witnesses(key)), override,
        )  # fmt: skip

    def unowned(self) -> list[str]:
        """What lies in the class folder and is nobody's, a sentence each; a file that was assigned is not."""
        with explained(self.book.path):
            told = msgspec.json.decode(self.book.meta().get("unrecognised", "[]"), type=list[str])
        files: dict[tuple[str, str], str] = {}
        for one in self.book.journal() if told else ():
            if one.kind == "assign":
                files[one.student, one.exercise] = counted_in(one.after).file  # "" where it was taken back
        names = tuple(f"{quoted(Path(file).name)}:" for file in files.values() if file)
        return [sentence for sentence in told if not sentence.startswith(names)]

    def unmatched(self, students: Iterable[str]) -> list[str]:
        """Students without exactly one row of the roster; none if there is no roster."""
        why = self.roster.match(students, self.downloads)[1] if self.roster else {}
        return [student for student, reason in why.items() if reason != FOR_TESTS]

    # -- parts ----------------------------------------------------------------------------------------

    def _submitted(self, key: Key) -> tuple[float | None, str]:
        """The time of submission, by the most trusted witness that has one."""
        told = self._witnesses(key)
        for source in self.policy.trust if self.policy else ("list", "gradescope"):
            times = [at for who, at in told if who == source and at is not None]
            if times:
                return min(times), source
        return None, ""

    def _witnesses(self, key: Key) -> list[tuple[str, float | None]]:
        """Who says when this very submission was handed in, and when."""
        known = self._times.get((key.student, key.exercise), ())
        return [(who, at) for sha256, who, at in known if sha256 in {"", key.submission_sha256}]

    def _due(self, key: Key, *, extended: bool = True) -> float | None:
        person = self.person(key.student) if extended else None
        names = (key.student, *([person.student] if person else [])) if extended else ()
        granted = person.extension_days or 0.0 if person else 0.0
        return self.policy.due(key.exercise, names, granted) if self.policy else None

    def hangs_on_the_clock(self, one: Effective, *, zoneless: bool) -> bool:
        """Whether an hour decides a penalty, and the clock may have been changed by one: in the days of an
        extension, in those by which it is late, or since the deadline where a time says no zone."""
        policy, at, key = self.policy, one.submitted_at, one.result.key
        first, due = (self._due(key, extended=extended) for extended in (False, True))
        if policy is None or policy.zone or at is None or first is None or due is None:
            return False
        hours = [lateness(at + shift, due) for shift in (-3600.0, 0.0, 3600.0)]
        costs = {policy.penalty(late, one.verdict.score, one.max_score, due) for late in hours}
        counts = zoneless or first != due or (one.late or 0.0) > _ALMOST_A_DAY
        return counts and len(costs) > 1 and may_change(first, max(due, at))

    def _passes(self, result: Result, score: float | None, most: float) -> bool:
        if score is None:
            return False
        if score == result.verdict.score:
            return result.verdict.passed
        noted = self._exercises.get(result.key.exercise)
        # The tolerance is rounding of sums of points, not mercy.
        return noted is not None and score >= noted.pass_share * most - 1e-9

    def nothing(self, student: str, exercise: str, state: str) -> Result:
        """Stands in for a grading where nothing was handed in."""
        noted = self._exercises.get(exercise)
        problem = _NOTHING[state]
        verdict = not_graded(exercise, noted.max_points if noted else 0.0, state, problem)
        return Result(Key(student, exercise, "", "", self.seed), verdict)


# ---
# The scores that a decision about the class changed, and by how much; stored with the decision.


#: By student and exercise: the score that counts, and the points there are.
Scores = dict[tuple[str, str], tuple[float | None, float | None]]
_NONE = (None, None)


class ScoreChange(msgspec.Struct, frozen=True):
    """A change of the score that counts, and of the points there are; None where there is no score."""

    student: str
    exercise: str
    before: float | None
    after: float | None
    max_before: float | None = None
    max_after: float | None = None


def counting(results: Results) -> Scores:
    return {(item.student, item.exercise): (item.score, item.max_score) for item in results.all()}


def moved(before: Scores, after: Scores) -> list[ScoreChange]:
    """The scores that are not the same, by student."""
    return [
        ScoreChange(*key, was, now, most_before, most_after)
        for key in sorted({*before, *after})
        for (was, most_before), (now, most_after) in [(before.get(key, _NONE), after.get(key, _NONE))]
        if was != now
    ]


@contextlib.contextmanager
def recorded(book: Gradebook, kind: str, reason: str) -> Iterator[list[ScoreChange]]:
    """Record which scores the decision in this block changed; they are in the list after it.

    Args:
        kind: as in ``Decision``.
    """
    told: list[ScoreChange] = []
    before = counting(Results(book))
    yield told
    told += moved(before, counting(Results(book)))
    old = [(one.student, one.exercise, one.before) for one in told]
    new = [(one.student, one.exercise, one.after) for one in told]
    texts = (msgspec.json.encode(old).decode(), msgspec.json.encode(new).decode())
    book.note(Decision("", "", kind, "", "", reason, *texts))


@contextlib.contextmanager
def replacing(book: Gradebook, view: Results, key: Key, untimed: list[str]) -> Iterator[None]:
    """Note in the journal if the result that this block puts in the place of another changes what counts.

    Args:
        untimed: gets the student and exercise if the work that counts now has no trusted time any more.
    """
    before = next(view.all(key.student, key.exercise), None)
    was = before.result.key if before is not None and before.result.number else key
    if was.submission_sha256 != key.submission_sha256:
        view.tie_times(was)
    yield
    after = next(view.all(key.student, key.exercise), None)
    if before is None or after is None or before.waiting:
        return  # it is the first
    if before.submitted_at is not None and after.submitted_at is None and view.policy is not None:
        untimed.append(f"{key.student} {key.exercise}")
    if (before.verdict.state, before.score) != (after.verdict.state, after.score):
        told = counted(before), counted(after)
        book.note(Decision("", "", "resume", key.student, key.exercise, "another submission", *told))


def counted(counts: Effective | None, file: str = "") -> str:
    """What counts for a student's exercise, as a decision about it keeps it.

    Args:
        file: the file that the instructor chose, if any.
    """
    if counts is None:
        return msgspec.json.encode({"state": "missing", "score": None}).decode()
    told: dict[str, object] = {"state": counts.verdict.state, "score": counts.score, "of": counts.max_score}
    told |= {"submission": counts.result.key.submission_sha256}
    if counts.verdict.error is not None:
        told["reason"] = counts.verdict.error.code
    return msgspec.json.encode(told | ({"file": file} if file else {})).decode()


class Counted(msgspec.Struct, frozen=True):
    """The digest of a submission, and the file that an instructor chose for it; "" where there is none."""

    submission: str = ""
    file: str = ""


def counted_in(told: str) -> Counted:
    """What ``counted`` told of the submission."""
    with contextlib.suppress(msgspec.MsgspecError, RecursionError):
        return msgspec.json.decode(told, type=Counted)
    return Counted()


# ---
# A score set by an instructor, with a reason: it replaces the graders', now and after any regrading.


_MAX_REASON = 2000


def override(results: Results, student: str, exercise: str, score: float, reason: str) -> Effective:
    """Set a score and store the reason; earlier decisions stay in the gradebook.

    Args:
        results: over a gradebook opened for writing.
        score: points, from 0 to the exercise's maximum.

    Raises:
        NotFoundError: the gradebook knows no such student or exercise.
        UsageError: no such score is possible, or there is no reason.
    """
    most = _maximum(results, student, exercise)
    if not math.isfinite(score) or not 0 <= score <= most:
        message = f"--score is {score:g}; {exercise} has 0 to {most:g} points."
        raise UsageError(message, help="Give the points that are to count.", code="impossible_score")
    reason = given_reason(reason, "An override", "it is shown wherever the score is")
    before = _told(next(results.all(student, exercise), None))
    results.book.add_override(Override(student, exercise, float(score) + 0.0, reason), before)
    return next(Results(results.book).all(student, exercise))


def given_reason(reason: str, what: str, shown: str) -> str:
    """An instructor's reason for a decision.

    Raises:
        UsageError: there is none, or it is too long.
    """
    reason = reason.strip()
    if not reason or len(reason) > _MAX_REASON:
        message = f"{what} needs a reason of at most {_MAX_REASON} characters."
        raise UsageError(message, help=f"Add --reason: {shown}.", code="no_reason")
    return reason


def lift(results: Results, student: str, exercise: str, reason: str) -> Effective | None:
    """Let the graders' result count again; None if there is none.

    Raises:
        NotFoundError: there is no override to lift.
    """
    _maximum(results, student, exercise)
    found = next(results.all(student, exercise), None)
    if found is None or found.override is None:
        explain = command("grade", "explain", results.folder, student, exercise)
        message = f"There is no override for {student!r} and {exercise}."
        raise NotFoundError(message, help=f"{explain} shows what counts.", code="no_override")
    results.book.add_override(Override(student, exercise, None, reason.strip()), _told(found))
    return next(Results(results.book).all(student, exercise), None)


def _told(counts: Effective | None) -> str:
    if counts is None or counts.score is None:
        return "no score"
    by = f"by hand: {counts.override.reason}" if counts.override else counts.verdict.state
    return f"{format_points(counts.score)}, {by}"


def no_exercise(exercise: str, known: Sequence[str]) -> NotFoundError:
    """What is said of an exercise that a gradebook does not have."""
    message = f"The gradebook has no exercise {exercise!r}."
    return NotFoundError(message, help=f"It has {', '.join(known) or 'none'}.", code="exercise_not_found")


def _only(students: Sequence[str], name: str) -> str:
    if len(students) > 1:
        message = f"{len(students)} students are called {name!r}."
        advice = f"The gradebook calls them {some([one_line(one) for one in students], 4)}: name one."
        raise NotFoundError(message, help=advice, code="student_not_found")
    return students[0] if students else name


def must_have(results: Results, student: str) -> None:
    """Refuse a name that is no student's.

    Raises:
        NotFoundError: the gradebook has no such student.
    """
    if student not in results.students():
        message = f"The gradebook has no student {student!r}."
        advice = "grades.csv lists all, and with a roster everybody who is enrolled."
        raise NotFoundError(message, help=advice, code="student_not_found")


def _maximum(results: Results, student: str, exercise: str) -> float:
    """The exercise's maximum; also checks that student and exercise exist."""
    graded = next(results.book.results(student, exercise), None)
    most = {item.id: item.max_points for item in results.exercises()}
    if graded is None and exercise not in most:
        raise no_exercise(exercise, list(most))
    must_have(results, student)
    return most[exercise] if exercise in most or graded is None else graded.verdict.max_score

"""Regrading the submissions in a gradebook, with the present graders or those of an earlier run.

The submissions come from the gradebook, so nothing else is needed, and hidden inputs are drawn with the same
seed. Submissions are regraded if another version of the graders scored them, or if a fault of ours left them
unscored. Old results are kept beside the new ones; an override still replaces both.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import msgspec

from course.catalog.load import Catalog
from course.catalog.questions import read_questions
from course.errors import IntegrityError, NotFoundError
from course.grading.gradebook.file import explained
from course.grading.gradebook.records import Decision, Key, Result
from course.grading.intake.students import Entry, about_a_file
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.quiz import grade_quiz, quiz_version
from course.grading.results.effective import Effective, Results, counted
from course.grading.running import run as running
from course.grading.running.batch import grade_all
from course.grading.running.run import QUIZ_RECORD, GradeAll, Ungraded, ungraded
from course.grading.running.snapshot import Snapshot, Unpacked, fresh, frozen, kept
from course.printable import some
from course.quizzing.bank import Bank
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import CheckResult, Verdict, format_points, in_points

#: Characters of a snapshot's digest that name it.
_LEAST_DIGITS = 6
#: Students who are named in a sentence.
_NAMED = 20


@dataclass(frozen=True)
class RerunOptions:
    """How to regrade.

    Attributes:
        dry_run: change nothing, only say what would change.
        everything: also regrade submissions that these graders have scored already.
        level, at_least: as in ``Terms``; the seed is the first run's.
        timeout: seconds of CPU time per check; None takes the first run's.
        against: the graders to use, as the number of a run or the beginning of a snapshot's digest; empty
            takes those of the course as it is now.
        accepted: digest of graders in the gradebook that may run though they are not this checkout's.
    """

    dry_run: bool = False
    everything: bool = False
    level: str | None = None
    at_least: str = "L2"
    timeout: float | None = None
    against: str = ""
    reason: str = ""
    accepted: str = ""


class CheckChange(msgspec.Struct, frozen=True):
    """A check with another outcome than before; None where there was or is no such check."""

    id: str
    before: str | None
    after: str | None
    points_before: float
    points_after: float


class Change(msgspec.Struct, frozen=True):
    """A student whose result has changed: counting scores, scores of the checks, and the points there are."""

    student: str
    exercise: str
    score_before: float | None
    score_after: float | None
    raw_before: float | None
    raw_after: float | None
    state_before: str
    state_after: str
    checks: tuple[CheckChange, ...]
    overridden: bool
    max_before: float = 0.0
    max_after: float = 0.0


class Regraded(msgspec.Struct, frozen=True):
    """The outcome of a regrading.

    Attributes:
        up_to_date: results from the same graders, which were left alone.
        kept: results whose submission is not in the gradebook (nothing was handed in, or it was refused), and
            those of ``gone``.
        gone: exercises that the graders do not have, with the number of their results.
        faults: submissions that a fault of ours kept from being graded; what counted before counts on.
        troubled: these.
        graders: digest of the snapshot that judged.
        unjudged: checks whose own code broke on a submission, a sentence each.
        rescaled: exercises that are worth other points now, and whose scores by hand are out of these, a
            sentence each.
    """

    regraded: int
    up_to_date: int
    kept: int
    faults: int
    changes: tuple[Change, ...]
    graders: str = ""
    troubled: tuple[Ungraded, ...] = ()
    unjudged: tuple[str, ...] = ()
    rescaled: tuple[str, ...] = ()
    gone: dict[str, int] = {}


def rerun(
    results: Results, catalog: Catalog, options: RerunOptions, *, grade: GradeAll = grade_all
) -> Regraded:
    """Regrade the submissions in a gradebook.

    Args:
        results: over a gradebook opened for writing, unless it is a dry run.

    Raises:
        MissingCapabilityError: there are no hidden graders here, or no sufficient protection.
        NotFoundError: the gradebook has no such graders.
        IntegrityError: a submission in the gradebook is damaged.
    """
    snapshot, recorded = _graders(results, catalog, options)
    changes: list[Change] = []
    troubled: list[Ungraded] = []
    broken: list[tuple[str, str, str]] = []
    regraded = 0
    with frozen(snapshot) as graders:
        task = _Rerun(results, graders, recorded, options)
        rescaled = _rescaled(results, graders.catalog)
        for before, after in task.pairs(grade):
            regraded += 1
            broken += running.broken_checks(after)
            change, error = _change(before, after), after.verdict.error
            if after.verdict.state == "grader_error" and error is not None:
                troubled.append(ungraded(after, error))
            elif change is not None:
                changes.append(change)
    return Regraded(
        regraded=regraded,
        up_to_date=task.up_to_date,
        kept=task.kept,
        faults=len(troubled),
        changes=tuple(changes),
        graders=snapshot.sha256,
        troubled=tuple(troubled),
        unjudged=running.unjudged(broken),
        rescaled=rescaled,
        gone=dict(+task.gone),
    )


def _rescaled(results: Results, catalog: Catalog) -> tuple[str, ...]:
    known = {*catalog.exercise_ids(), *catalog.warm_up_ids()}
    told = []
    for noted in results.exercises():
        now = catalog.exercise(noted.id).max_points if noted.id in known else noted.max_points
        set_ones = [one for one in results.all(exercise=noted.id) if one.override is not None]
        if set_ones and now != noted.max_points:
            was, of = format_points(noted.max_points), format_points(now)
            names = some([results.named(one.student) for one in set_ones], _NAMED)
            told.append(
                f"{noted.id} is worth {in_points(now)} and was worth {was}: scores by hand stay as they are,"
                f" and are out of {of} now: {names}."
            )
    return tuple(told)


def _graders(results: Results, catalog: Catalog, options: RerunOptions) -> tuple[Snapshot, dict[str, Any]]:
    """The graders to use, and the options of the run they judged before."""
    book, against = results.book, options.against
    if not against:
        catalog.content.instructors()
        return fresh(catalog.content), book.run_options()
    runs = [run for run in book.runs() if run.options.get("snapshot")]
    wanted = [run for run in runs if str(run.number) == against]
    if not wanted and len(against) >= _LEAST_DIGITS:  # fewer could be the number of a run that is not there
        wanted = [run for run in runs if run.options["snapshot"].startswith(against)]
    sha256 = wanted[-1].options["snapshot"] if wanted else None
    snapshot = kept(book, sha256, catalog.content, options.accepted)
    if snapshot is None:
        message = f"The gradebook has no graders of a run or a snapshot {against!r}."
        advice = "`course grade log` lists the runs and their snapshots."
        raise NotFoundError(message, help=advice, code="snapshot_not_found")
    return snapshot, wanted[-1].options


class _Rerun:
    def __init__(
        self, results: Results, graders: Unpacked, recorded: dict[str, Any], options: RerunOptions
    ) -> None:
        self._results = results
        self._graders = graders
        self._recorded = recorded
        self._options = options
        catalog = graders.catalog
        there = {*results.book.exercise_ids(), *(item.id for item in results.exercises())}
        known = {*catalog.exercise_ids(), *catalog.warm_up_ids()}
        self._exercises = {name: catalog.exercise(name) for name in there if name in known}
        self._versions = {name: graders.version(name) for name in self._exercises}
        self._bank = Bank(read_questions(graders.catalog.content.quiz))
        self._versions[QUIZ] = quiz_version(self._bank)
        self._before: dict[tuple[str, str], Effective] = {}
        self._begun = False
        self.up_to_date = self.kept = 0
        self.gone: Counter[str] = Counter()

    def pairs(self, grade: GradeAll) -> Iterator[tuple[Effective, Effective]]:
        """The scores before and after, for each regraded submission."""
        options, results = self._options, self._results
        timeout = options.timeout or float(self._recorded.get("timeout", 10.0))
        graders = self._graders.snapshot.sha256
        terms = Terms(options.level, options.at_least, timeout, results.seed, graders)
        # Read before anything is written: what is newest changes while results come in.
        waiting = [(item.result.key, item.verdict.state) for item in results.all() if item.result.number]
        for graded in grade(self._entries(waiting), terms):
            entry = graded.entry
            key = self._key(entry.student, entry.exercise.id, entry.sha256)
            if graded.version:
                key = replace(key, grader_version=graded.version)
            yield self._taken(key, graded.verdict)
        for key, state in waiting:
            if key.exercise == QUIZ and self._is_due(key, state):
                yield from self._quiz(key)

    def _entries(self, waiting: list[tuple[Key, str]]) -> Iterator[Entry]:
        for key, state in waiting:
            if key.exercise != QUIZ and self._is_due(key, state):
                files = self._results.book.submission(key.submission_sha256)
                exercise = self._exercises.get(key.exercise)
                if files is None or exercise is None:
                    self.kept += 1
                    self.gone[key.exercise] += exercise is None
                    continue
                submission = Submission(files)
                if submission.sha256 != key.submission_sha256:
                    raise IntegrityError(
                        f"What {key.student!r} handed in for {key.exercise} is damaged in the gradebook.",
                        help="Restore the gradebook from a backup, or grade the class into a new folder.",
                    )
                self._remember(key)
                yield Entry(key.student, exercise, submission)

    def _is_due(self, key: Key, state: str) -> bool:
        same = self._versions.get(key.exercise) == key.grader_version
        if same and state != "grader_error" and not self._options.everything:
            self.up_to_date += 1
            return False
        return True

    def _quiz(self, key: Key) -> Iterator[tuple[Effective, Effective]]:
        files = self._results.book.submission(key.submission_sha256)
        with explained(self._results.book.path):
            record = msgspec.json.decode(files.get(QUIZ_RECORD, b"")) if files else None
        verdict = grade_quiz(self._bank, record) if record is not None and self._bank.ids else None
        if verdict is None:
            self.kept += 1
            return
        self._remember(key)
        yield self._taken(self._key(key.student, QUIZ, key.submission_sha256), verdict)

    def _remember(self, key: Key) -> None:
        self._before[key.student, key.exercise] = next(self._results.all(key.student, key.exercise))

    def _key(self, student: str, exercise: str, sha256: str) -> Key:
        return Key(student, exercise, sha256, self._versions[exercise], self._results.seed)

    def _taken(self, key: Key, verdict: Verdict) -> tuple[Effective, Effective]:
        before = self._before.pop((key.student, key.exercise))
        # Which file it is was found out when it was read, and it is not read again.
        notes = [one for one in before.verdict.warnings if about_a_file(one) and one not in verdict.warnings]
        result = Result(key, msgspec.structs.replace(verdict, warnings=(*verdict.warnings, *notes)))
        after = self._results.of(result)
        fault = verdict.state == "grader_error" and before.verdict.state != "grader_error"
        if not self._options.dry_run and not fault:
            if not self._begun:
                self._begin()
            self._results.book.add(result)
            was, now = ((one.verdict.state, one.score, one.max_score) for one in (before, after))
            if was != now:
                told = self._options.reason or "graded again", counted(before), counted(after)
                self._results.book.note(Decision("", "", "rerun", key.student, key.exercise, *told))
        return before, after

    def _begin(self) -> None:
        """From the first new result on: a regrading that finds nothing to do leaves no trace."""
        self._begun = True
        options, book = self._options, self._results.book
        snapshot = self._graders.snapshot
        facts = {**book.run_options(), "level": options.level, "at_least": options.at_least}
        book.keep_snapshot(snapshot.sha256, snapshot.packed)
        book.begin_run("rerun", {**facts, "snapshot": snapshot.sha256, "reason": options.reason})
        book.set_meta(version=self._graders.catalog.version)
        noted = {item.id for item in self._results.exercises()}
        bank = self._bank if QUIZ in noted and self._bank.ids else None
        graded = [item for name, item in self._exercises.items() if name in noted]
        book.set_exercises(running.graded_exercises(graded, bank))


def _change(before: Effective, after: Effective) -> Change | None:
    """The change; None if nothing visible changed."""
    old = {check.id: check for check in before.verdict.checks}
    new = {check.id: check for check in after.verdict.checks}
    checks = []
    for name in dict.fromkeys((*old, *new)):
        was, now = _outcome(old.get(name)), _outcome(new.get(name))
        if was != now:
            checks.append(CheckChange(name, was[0], now[0], was[1], now[1]))
    counted_before, counts = ((one.score, one.raw_score, one.verdict.state) for one in (before, after))
    if counted_before == counts and not checks:
        return None
    return Change(
        after.student, after.exercise, before.score, after.score, before.raw_score, after.raw_score,
        before.verdict.state, after.verdict.state, tuple(checks), after.override is not None,
        before.max_score, after.max_score,
    )  # fmt: skip


def _outcome(check: CheckResult | None) -> tuple[str | None, float, float]:
    """A check's status, its points, and the points there are."""
    return (check.status.value, check.points, check.max_points) if check else (None, 0.0, 0.0)

"""Grades submissions of one exercise: checks collected once, a proven sandbox kept warm.

with GradingSession(exercise, catalog, scope="public") as session:
    verdict = session.grade(Submission({"integrators.py": source}))
"""

from __future__ import annotations

import contextlib
import os
import random
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, Literal, Self, TypeVar

import msgspec

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.errors import ContentError, InternalError, MissingCapabilityError, NotFoundError, UngradableError
from course.figures.described import Curve, compared, marched
from course.isolation.failures import IsolationError, StudentFailure
from course.isolation.launch import keep_private
from course.isolation.levels import Level, Spawner
from course.isolation.probe import open_sandbox
from course.isolation.session import LoadRefusedError
from course.printable import beginning
from course.scoring import versions
from course.scoring.checks.collected import (
    Check,
    CollectedChecks,
    companion,
    not_importable,
    questions_of,
    questions_path,
)
from course.scoring.explain.story import read_table
from course.scoring.failures import (
    CLOCK,
    ON_THE_MODEL,
    CheckFailed,
    Report,
    broke_at,
    finding_for,
    finding_of,
)
from course.scoring.judging import outcomes
from course.scoring.judging.explaining import Again, Explainer
from course.scoring.judging.outcomes import found, load_problem, result
from course.scoring.judging.submission import Submission, Terms
from course.scoring.remote import Heard, RemoteSubmission
from course.scoring.verdict import OURS, CheckResult, Places, Problem, Status, Verdict, Visibility, bounded

Scope = Literal["public", "full"]
T = TypeVar("T")

_LESS_TIME = 4
_PRINTED = 4000  # characters of what a submission prints in one check, or while it is loaded
#: Of failures that end otherwise than they are called.
_STATUS = {"missing": Status.ERROR, "protocol": Status.CRASH}


class GradingSession:
    """Checks and sandbox of one exercise, ready for any number of submissions.

    Args:
        scope: "public" for the checks a student has, "full" for the hidden ones too.
        processor: picks the processor to stay on; None picks any.

    Attributes:
        running: title of the running check; empty between runs.
        asked: for each check that has run, the functions of the last submission that it used.
        took: and the CPU time of the worker for it, s.
        printed: the last submission's output while it was loaded.
        curves: for failed checks at home, the student's curve and the right one, if they show anything.

    Raises:
        MissingCapabilityError: this machine cannot provide the level, or the hidden checks are not here.
        ContentError: a check file is wrong.
    """

    def __init__(
        self,
        exercise: Exercise,
        catalog: Catalog,
        *,
        scope: Scope = "public",
        terms: Terms = Terms(),  # noqa: B008 - it cannot change
        processor: int | None = None,
    ) -> None:
        self.exercise = exercise
        self.scope = scope
        self._terms = terms
        self._processor = _choose(processor)
        if scope == "full":
            keep_private()
        self._catalog = catalog
        self._failed: dict[str, CheckFailed] = {}  # of the submission at hand
        self._raised: dict[str, tuple[Any, ...]] = {}  # arguments of the call that ended a check
        self._heard: dict[str, tuple[float, list[Heard]]] = {}  # calls of its failed checks, and their time
        self._explainer = _explainer(exercise)
        self._sound: dict[str, bool] = {}  # of checks that broke: whether they pass the model solution
        self._checks = CollectedChecks(check_files(exercise, catalog, scope), draws=scope == "full")
        with pinned_to(self._processor):  # the workers inherit it
            self._spawner, self._processor = _open(exercise.imports, terms, self._processor)
        self.level: str = self._spawner.level.value
        self._remote: RemoteSubmission | None = None
        self.running = ""
        self.asked: dict[str, frozenset[str]] = {}
        self.took: dict[str, float] = {}
        self.printed = ""
        self.curves: dict[str, Curve] = {}
        self._hung: set[str] = set()  # tasks of the submission at hand with a check that ran out of time

    @property
    def checks(self) -> tuple[Check, ...]:
        """The checks, in the order they are shown."""
        return self._checks.checks

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the sandbox; safe to call twice."""
        self._spawner.close()
        self._checks.close()

    def drop(self) -> None:
        """From another thread: end the present run; its verdict is not valid."""
        remote = self._remote
        if remote is not None:
            remote.give_up()

    def grade(self, submission: Submission, *, only: Collection[str] = ()) -> Verdict:
        """The verdict on one submission.

        Args:
            only: ids of the checks to run, together with those they require; the others are left out of the
                verdict. Empty means all.

        Nothing that a submission does raises an exception here; a fault of the grader is in the verdict as
        "grader_error".
        """
        with pinned_to(self._processor):
            verdict = self._grade(submission, only)
        told = [*submission.notes]
        if self._terms.home:
            told += versions.notes(submission.files[self.exercise.module], self._places(submission))
        return msgspec.structs.replace(verdict, warnings=(*verdict.warnings, *told))

    def _grade(self, submission: Submission, only: Collection[str]) -> Verdict:
        self.printed = ""
        try:
            remote = self._load(submission)
        except LoadRefusedError as refused:
            self.printed = beginning(refused.printed, _PRINTED)
            problem = load_problem(refused, self._places(submission), self.exercise.id)
            return self._verdict("ungradable", error=problem)
        except IsolationError as error:
            return self._grader_error(str(error))
        try:
            if not any(task.id in remote.functions for task in self.exercise.task):
                return self._verdict("ungradable", error=self._nothing_loaded(remote, submission))
            self._remote = remote
            tasks = [task.id for task in self.exercise.task]
            left_out = outcomes.left_out_notes(remote, self._places(submission), tasks)
            self.printed = beginning(remote.printed(), _PRINTED)
            results = self._run(remote, only, submission)
        except IsolationError as error:
            return self._grader_error(str(error))
        finally:
            self._remote, self.running = None, ""
            with contextlib.suppress(IsolationError):
                remote.close()
        if self._terms.home and len(self.exercise.task) > 1:
            results = outcomes.to_do(results, outcomes.untouched(self.exercise, submission))
        verdict = self._graded(results)
        if not self._terms.home:
            left_out += [
                f"`{task}` ran out of time in one check; each further check of it had a quarter of that."
                for task in sorted(self._hung)
                if sum(result.task == task for result in results) > 1
            ]
        return msgspec.structs.replace(verdict, warnings=(*verdict.warnings, *left_out))

    def _nothing_loaded(self, remote: RemoteSubmission, submission: Submission) -> Problem:
        """Why none of the functions is there."""
        fault = next((one for one in remote.faults if one.stage in {"syntax", "import"}), None)
        if fault is None:
            return outcomes.no_functions(self.exercise)
        refused = LoadRefusedError(fault.stage, fault.failure, fault.text, fault.code)
        return load_problem(refused, self._places(submission), self.exercise.id)

    def using(self, submission: Submission, use: Callable[[RemoteSubmission], T]) -> T:
        """The result of ``use`` on a submission, loaded as for a check; one deadline applies to all of it.

        Raises:
            UngradableError: it cannot be loaded.
            InternalError: the sandbox broke.
        """
        with pinned_to(self._processor):
            try:
                remote = self._load(submission)
            except LoadRefusedError as refused:
                problem = load_problem(refused, self._places(submission), self.exercise.id)
                raise UngradableError(problem.message, help=problem.help, code=problem.code) from None
            except IsolationError as error:
                raise InternalError(f"The submission could not be run: {error}.") from None
            try:
                remote.begin_check()
                return use(remote)
            finally:
                with contextlib.suppress(IsolationError):
                    remote.close()

    # -- checks ---------------------------------------------------------------------------------------

    def _load(self, submission: Submission) -> RemoteSubmission:
        """The submission in a worker; the benchmarks replace it with an unprotected one."""
        return RemoteSubmission(
            self._spawner, submission.files, self.exercise.module,
            timeout=self.exercise.time * self._terms.timeout, times=self.exercise.time,
            seed=self._terms.seed, places=self._places(submission),
            home=self._terms.home, patience=self.exercise.patience() if self._terms.home else None,
            tasks=[task.id for task in self.exercise.task],
            listened=self._explainer.listened(submission.files[self.exercise.module])
            if self._explainer else frozenset(),
        )  # fmt: skip

    def _places(self, submission: Submission) -> Places:
        return submission.places or Places(module=self.exercise.module)

    def _run(
        self, remote: RemoteSubmission, only: Collection[str], submission: Submission
    ) -> list[CheckResult]:
        places = self._places(submission)
        wanted = set(only)
        ordered = self._checks.in_order()
        if only:
            for check in reversed(ordered):  # each comes after those it requires
                wanted.update(check.requires if check.id in wanted else ())
            ordered = [check for check in ordered if check.id in wanted]
        source = submission.files[self.exercise.module]
        results: dict[str, CheckResult] = {}
        of_this_run = self._failed, self._raised, self._heard, self._hung, self.asked, self.took, self.curves
        for kept in of_this_run:
            kept.clear()
        for check in ordered:
            blocking = [name for name in check.requires if results[name].status is not Status.PASS]
            results[check.id] = (
                outcomes.skipped(check, blocking[0]) if blocking else self._run_one(check, remote, places)
            )
        if self._explainer is not None and self._failed:
            with Again(lambda: self._load(submission)) as again:
                self._explainer.explain(results, self._failed, remote, source, self._heard, again)
        for name, judged in results.items():
            if judged.status in {Status.FAIL, Status.ERROR}:
                fact = self._common(judged, remote)
                results[name] = outcomes.told_more(judged, source, places, self._raised.get(name), fact)
        return [results[check.id] for check in self._checks.checks if check.id in results]

    def _run_one(self, check: Check, remote: RemoteSubmission, places: Places) -> CheckResult:
        self.running = check.title
        hung = check.task in self._hung
        remote.begin_check(check.task, self._patience(check, hung))
        CLOCK.set(lambda: remote.used)
        start = perf_counter()
        outcome = self._checks.run(check, remote)
        self.asked[check.id], self.took[check.id] = frozenset(remote.asked), remote.used
        duration_ms = (perf_counter() - start) * 1e3
        printed = beginning(remote.printed(), _PRINTED) or None
        if outcome is None:
            said = printed if self._terms.home else None
            return result(check, Status.PASS, points=check.points, duration_ms=duration_ms, stdout=said)
        match outcome:
            case IsolationError():
                raise outcome
            case CheckFailed():
                remote.not_charged(outcome.search_s)
                self._failed[check.id] = outcome
                self._heard[check.id] = remote.used, remote.heard
                self._keep_curve(check, outcome, remote)
                ours = OURS + outcome.broke if outcome.broke else None
                return found(check, Status.FAIL, outcome.finding, duration_ms, traceback=ours, stdout=printed)
            case StudentFailure():
                status = _STATUS.get(outcome.kind) or Status(outcome.kind)
                if outcome.type == "UnsupportedValue":
                    status = Status.ERROR
                if status is Status.TIMEOUT:
                    self._hung.add(check.task)
                traceback = places.trace(outcome.traceback) or None
                finding = finding_of(outcome, shown=check.visibility == "public")
                if outcome.kind == "error" and remote.asking and remote.asking[0] == check.task:
                    self._raised[check.id] = remote.asking[1]
                return found(check, status, finding, duration_ms, traceback=traceback, stdout=printed)
        where = broke_at(outcome)
        proven = self._passes_the_model(check)
        if proven is False:
            message = ON_THE_MODEL + where
            return result(check, Status.GRADER_ERROR, message=message, duration_ms=duration_ms)
        finding = outcomes.unjudged(remote.returned, proven=bool(proven))
        return found(check, Status.FAIL, finding, duration_ms, traceback=OURS + where, stdout=printed)

    def _common(self, judged: CheckResult, remote: RemoteSubmission) -> str | None:
        """What all wrong results of a public check have in common, where it can say so and names nothing."""
        failed = self._failed.get(judged.id)
        if judged.diagnosis or judged.visibility is not Visibility.PUBLIC or not (failed and failed.common):
            return None
        remote.begin_check(judged.task)
        with contextlib.suppress(CheckFailed, StudentFailure):
            return failed.common()
        return None

    def _patience(self, check: Check, hung: bool) -> float | None:
        """Seconds of CPU time for a check; less where another of its function ran out of time before.

        A function that never answers would hold a busy grader for minutes of wall time.
        """
        if self._terms.home:
            return self.exercise.patience(check.id, hung)
        return self.exercise.time * self._terms.timeout / _LESS_TIME if hung else None

    def _keep_curve(self, check: Check, failed: CheckFailed, remote: RemoteSubmission) -> None:
        if not self._terms.home:
            return
        curve = compared(*failed.comparison) if failed.comparison else None
        curve = curve or (marched(*remote.marched) if remote.marched else None)
        if curve is not None:
            self.curves[check.id] = curve

    def _passes_the_model(self, check: Check) -> bool | None:
        """Whether a check that broke on a submission passes the model solution; None without one here."""
        solution = self._catalog.content.solution_folder(self.exercise.id)
        if solution is None:
            return None
        if check.id not in self._sound:
            source = (solution / self.exercise.module).read_bytes()
            try:
                model = self._load(Submission({self.exercise.module: source}))
            except LoadRefusedError:
                return False
            try:
                model.begin_check(check.task)
                self._sound[check.id] = self._checks.run(check, model) is None
            finally:
                model.close()
        return self._sound[check.id]

    # -- verdicts -------------------------------------------------------------------------------------

    def _graded(self, results: list[CheckResult]) -> Verdict:
        broken = next((result for result in results if result.status is Status.GRADER_ERROR), None)
        if broken is None:
            return self._verdict("graded", results)
        problem = Problem("check_failed", f"{broken.id}: {broken.message}", "Regrade once it is repaired.")
        return self._verdict("grader_error", results, problem)

    def _grader_error(self, message: str) -> Verdict:
        help_ = "Run `course doctor`, then grade this submission again."
        return self._verdict("grader_error", error=Problem("isolation_failed", message, help_))

    def _verdict(
        self, state: str, results: Sequence[CheckResult] = (), error: Problem | None = None
    ) -> Verdict:
        graded = state == "graded"
        score = sum((result.points for result in results), 0.0)
        most = sum(result.max_points for result in results) if graded else sum(c.points for c in self.checks)
        verdict = Verdict(
            exercise=self.exercise.id,
            scope=self.scope,
            state=state,
            score=score,
            max_score=most,
            # The tolerance only covers rounding in sums of points.
            passed=graded and score >= self.exercise.pass_mark * most - 1e-9,
            checks=tuple(results),
            isolation=self.level,
            error=error,
        )
        return bounded(verdict)


def check_files(exercise: Exercise, catalog: Catalog, scope: Scope) -> list[tuple[Path, Visibility]]:
    """The files whose checks a scope runs.

    Raises:
        MissingCapabilityError: the full scope needs hidden checks and model solutions; one is not here.
    """
    files = [(exercise.checks_path, Visibility.PUBLIC)]
    if scope == "full":
        _, graders = catalog.content.instructors()
        hidden = graders / catalog.content.place_of(exercise.id) / "checks.py"
        if hidden.is_file():
            files.append((hidden, Visibility.HIDDEN))
        elif exercise.hidden_checks:
            problem = f"it is missing, and {exercise.id} has {exercise.hidden_checks} hidden checks."
            raise ContentError(hidden, None, problem, help="Restore the file.")
    return files


def _explainer(exercise: Exercise) -> Explainer | None:
    """The explainer of failed checks, for an exercise whose words are data."""
    table = read_table(Path(exercise.folder))
    if table is None:
        return None
    try:
        questions = questions_of(exercise.id)
    except Exception as error:  # noqa: BLE001 - whatever a file does that is imported
        raise not_importable(error, questions_path(exercise.id)) from None
    return Explainer(table, questions) if questions else None


def _open(imports: tuple[str, ...], terms: Terms, processor: int | None) -> tuple[Spawner, int | None]:
    lowest = Level(terms.level or terms.at_least)
    highest = Level.L3 if terms.level is None else lowest
    try:
        return open_sandbox(imports, at_least=lowest, at_most=highest, processor=processor)
    except IsolationError as error:
        message = f"This machine cannot run submissions at protection level {lowest}: {error}."
        advice = "`course doctor` says what would raise the level."
        raise MissingCapabilityError(message, help=advice, code="protection_level") from None


def _choose(processor: int | None) -> int | None:
    """The processor to grade on; None where processes are not pinned."""
    if not hasattr(os, "sched_getaffinity"):
        return None
    available = sorted(os.sched_getaffinity(0))
    return random.choice(available) if processor is None else available[processor % len(available)]


@contextlib.contextmanager
def pinned_to(processor: int | None) -> Iterator[None]:
    """Pin this thread, and the processes it starts, to one processor for the duration.

    Grader and worker take turns and never run at the same time. On one processor, a callback costs about a
    third of what it costs to wake another processor, and the caches stay warm.
    """
    if processor is None:
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {processor})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


# ---
# The report of an exercise: its ``report.py``, run on a submission through the boundary of the checks.


FILE = "report.py"


def has_report(exercise: Exercise) -> bool:
    """Whether the exercise has something to show."""
    return (Path(exercise.folder) / FILE).is_file()


def report_of(exercise: Exercise, catalog: Catalog, submission: Submission) -> Report:
    """The report on a submission.

    Raises:
        NotFoundError: the exercise has no report.
        UngradableError: the submission cannot be loaded, or ended the report.
        MissingCapabilityError: no submission can be run on this machine.
    """
    if not has_report(exercise):
        message = f"The exercise {exercise.id} has no report."
        advice = f"See what its checks say: course check {exercise.id}"
        raise NotFoundError(message, help=advice, code="report_not_found")
    module = companion(exercise.id, FILE.removesuffix(".py"))
    try:
        with GradingSession(exercise, catalog, terms=Terms(timeout=60.0)) as session:
            report: Report = session.using(submission, module.report)
    except (StudentFailure, CheckFailed) as failure:
        finding = finding_for(failure)
        raise UngradableError(finding.message, help=finding.help or "", code="report_stopped") from None
    return report

"""Whether each wrong solution is caught as declared: by that check, with that diagnosis, and only there."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from course.authoring.exercises.grading import (
    GradeSources,
    compose,
    grade_sources,
    solution_path,
    solutions_folder,
)
from course.authoring.report import Progress
from course.catalog.load import Catalog
from course.catalog.models import Exercise, Mutant
from course.scoring.verdict import OURS, CheckResult, Status, Verdict


@dataclass(frozen=True, slots=True)
class Fault:
    """One unexpected result of a grading; ``key`` is the key of mutants.toml that it concerns."""

    message: str
    fix: str
    key: str = "file"


@dataclass(frozen=True, slots=True)
class MutantOutcome:
    """The outcome for a mutant.

    Attributes:
        caught_by: ids of the checks that did not pass, in order.
        diagnosis: the diagnosis of the check it names; None if that check passed.
        message, help: what the student would read there.
        faults: empty if everything is as declared.
    """

    mutant: Mutant
    caught_by: tuple[str, ...]
    diagnosis: str | None
    message: str
    help: str
    lost: float
    faults: tuple[Fault, ...]


def mutant_path(catalog: Catalog, exercise: Exercise, mutant: Mutant) -> Path:
    return solutions_folder(catalog, exercise) / "mutants" / mutant.file


def run_mutants(
    catalog: Catalog,
    exercise: Exercise,
    *,
    on_progress: Progress | None = None,
    grade: GradeSources = grade_sources,
) -> tuple[MutantOutcome, ...]:
    """Grade every mutant of an exercise and compare with what mutants.toml says."""
    mutants = catalog.mutants(exercise)
    solution = solution_path(catalog, exercise)
    sources = [compose(solution, mutant_path(catalog, exercise, mutant)) for mutant in mutants]
    verdicts: dict[int, Verdict] = {}
    if on_progress:
        on_progress(0, len(mutants), "")
    for index, verdict in grade([(exercise, source) for source in sources]):
        verdicts[index] = verdict
        if on_progress:
            on_progress(len(verdicts), len(mutants), f"{exercise.id}: {mutants[index].file}")
    return tuple(outcome_of(mutant, verdicts[index]) for index, mutant in enumerate(mutants))


def outcome_of(mutant: Mutant, verdict: Verdict) -> MutantOutcome:
    """A mutant and its verdict, compared."""
    named = _result(verdict, mutant.check)
    caught = named is not None and named.status is not Status.PASS
    return MutantOutcome(
        mutant=mutant,
        caught_by=tuple(check.id for check in verdict.checks if check.status is not Status.PASS),
        diagnosis=named.diagnosis if named and caught else None,
        message=named.message if named and caught else "",
        help=named.help if named and caught else "",
        lost=verdict.max_score - verdict.score,
        faults=judge(mutant, verdict),
    )


def judge(mutant: Mutant, verdict: Verdict) -> tuple[Fault, ...]:
    """Everything that differs from the mutant's entry; empty if nothing does."""
    if verdict.state != "graded":
        why = verdict.error.message if verdict.error else verdict.state
        return (Fault(f"could not be graded: {why}", "A mutant is wrong code that runs; correct it."),)
    failed = [check for check in verdict.checks if check.status is not Status.PASS]
    if not failed:
        return (Fault("survives: every check passes.", f"Make check {mutant.check} catch it.", "check"),)
    faults = [*_judge_named(mutant, _result(verdict, mutant.check))]
    faults += [
        Fault(
            f"fails check {check.id} of task {check.task}, and should break {mutant.task} only"
            f" ({check.status}: {check.message or check.blocked_by}).",
            "Let each check call only its own task's function, or narrow the mutant.",
            "task",
        )
        for check in failed
        if check.task != mutant.task
    ]
    faults += [
        Fault(
            f"breaks the diagnosis of check {check.id}: {check.traceback.removeprefix(OURS)}.",
            "A probe gets whatever a wrong program returns; let it look before it computes.",
            "diagnosis",
        )
        for check in failed
        if check.traceback and check.traceback.startswith(OURS)
    ]
    if all(check.points == check.max_points for check in failed):
        faults.append(Fault("loses no points.", "Give points to the checks that catch it.", "check"))
    return tuple(faults)


def _judge_named(mutant: Mutant, named: CheckResult | None) -> tuple[Fault, ...]:
    if named is None:
        return (Fault(f"names check {mutant.check}, which does not exist.", "Correct the id.", "check"),)
    if named.task != mutant.task:
        return (
            Fault(
                f"names check {named.id}, which belongs to task {named.task}.",
                "Name one of its task.",
                "check",
            ),
        )
    if named.status is Status.PASS:
        return (
            Fault(f"is not caught by {named.id}.", "Sharpen that check, or name the one that does.", "check"),
        )
    if (named.diagnosis or "") not in (mutant.diagnosis, *mutant.also):
        return (
            Fault(
                f"is diagnosed as {named.diagnosis} by {named.id} ({named.status}),"
                f" not as {mutant.diagnosis}.",
                "Teach the check's diagnosis to recognise it, or correct the entry.",
                "diagnosis",
            ),
        )
    return ()


def _result(verdict: Verdict, check_id: str) -> CheckResult | None:
    return next((check for check in verdict.checks if check.id == check_id), None)

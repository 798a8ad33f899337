"""Whether each wrong program is caught as on record: by that check, under its own name, and only there."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import msgspec

from course.authoring.exercises.grading import (
    grade_sources,
    mistakes_of,
    solution_path,
    solutions_folder,
)
from course.authoring.mistakes import Mistakes, Variant, mistakes_path
from course.authoring.report import Progress
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.reading import read_text
from course.errors import ContentError
from course.progress.workspace import write_atomically
from course.scoring.verdict import OURS, CheckResult, Status, Verdict


@dataclass(frozen=True, slots=True)
class Fault:
    """One unexpected result of a grading."""

    message: str
    fix: str


@dataclass(frozen=True, slots=True)
class MutantOutcome:
    """The outcome for a mutant.

    Attributes:
        check: id of the one that is on record for catching it; "" where none is.
        looks_like: the words of its mistake.
        caught_by: ids of the checks that did not pass, in order.
        by: id of the check that caught it, best under its own name; "" for none.
        diagnosis: the diagnosis of that check, or of the first that caught it; None if it passed.
        message, help: what the student would read there.
        faults: empty if everything is as declared.
    """

    mutant: Variant
    check: str
    looks_like: str
    caught_by: tuple[str, ...]
    by: str
    diagnosis: str | None
    message: str
    help: str
    lost: float
    faults: tuple[Fault, ...]


def run_mutants(
    catalog: Catalog,
    exercise: Exercise,
    *,
    on_progress: Progress | None = None,
) -> tuple[MutantOutcome, ...]:
    """Grade every wrong program of an exercise and compare with what is on record."""
    mistakes, solution = mistakes_of(catalog, exercise), solution_path(catalog, exercise)
    model, file, caught = read_text(solution), mistakes_path(solution.parent), caught_by(catalog, exercise)
    sources = [variant.composed(model, file).encode() for variant in mistakes.wrong]
    verdicts: dict[int, Verdict] = {}
    if on_progress:
        on_progress(0, len(sources), "")
    for index, verdict in grade_sources([(exercise, source) for source in sources]):
        verdicts[index] = verdict
        if on_progress:
            on_progress(len(verdicts), len(sources), f"{exercise.id}: {mistakes.wrong[index].name}")
    return tuple(
        outcome_of(variant, caught.get(variant.name, ""), verdicts[index], mistakes)
        for index, variant in enumerate(mistakes.wrong)
    )


def outcome_of(mutant: Variant, check: str, verdict: Verdict, mistakes: Mistakes) -> MutantOutcome:
    """A wrong program and its verdict, compared."""
    named = _result(verdict, check) if check else None
    if named is None or named.status is Status.PASS:
        named = _first(mutant, verdict)
    caught = named is not None and named.status is not Status.PASS
    words = mistakes.words.get(mutant.code)
    return MutantOutcome(
        mutant=mutant,
        check=check,
        looks_like=words.looks_like if words else "",
        caught_by=tuple(check.id for check in verdict.checks if check.status is not Status.PASS),
        by=named.id if named and caught else "",
        diagnosis=named.diagnosis if named and caught else None,
        message=named.message if named and caught else "",
        help=named.help if named and caught else "",
        lost=verdict.max_score - verdict.score,
        faults=judge(mutant, check, verdict),
    )


def judge(mutant: Variant, check: str, verdict: Verdict) -> tuple[Fault, ...]:
    """Everything that differs from the program's entry; empty if nothing does.

    Args:
        check: id of the one that is on record for catching it; "" for any, as in a warm-up, which has few.
    """
    if verdict.state != "graded":
        why = verdict.error.message if verdict.error else verdict.state
        return (Fault(f"could not be graded: {why}", "A mutant is wrong code that runs; correct it."),)
    failed = [check for check in verdict.checks if check.status is not Status.PASS]
    if not failed:
        return (Fault("survives: every check passes.", "Sharpen a check, or take it out."),)
    faults = [*_judge_named(mutant, check, _result(verdict, check) if check else _first(mutant, verdict))]
    faults += [
        Fault(
            f"fails check {check.id} of task {check.task}, and should break {mutant.task} only"
            f" ({check.status}: {check.message or check.blocked_by}).",
            "Let each check call only its own task's function, or narrow the mutant.",
        )
        for check in failed
        if check.task != mutant.task
    ]
    faults += [
        Fault(
            f"breaks the diagnosis of check {check.id}: {check.traceback.removeprefix(OURS)}.",
            "A probe gets whatever a wrong program returns; let it look before it computes.",
        )
        for check in failed
        if check.traceback and check.traceback.startswith(OURS)
    ]
    if all(check.points == check.max_points for check in failed):
        faults.append(Fault("loses no points.", "Give points to the checks that catch it."))
    return tuple(faults)


def _judge_named(mutant: Variant, check: str, named: CheckResult | None) -> tuple[Fault, ...]:
    again = "Sharpen that check, or accept the new record with `course author build --accept`."
    if named is None:
        return (Fault(f"is caught by {check} on record, and there is no such check.", again),)
    if named.task != mutant.task:
        return (Fault(f"is caught by {named.id} on record, which belongs to task {named.task}.", again),)
    if named.status is Status.PASS:
        return (Fault(f"is not caught by {named.id}, as it is on record.", again),)
    if (named.diagnosis or "") not in (mutant.code, *mutant.also):
        said = f"is diagnosed as {named.diagnosis} by {named.id} ({named.status}), not as {mutant.code}."
        return (Fault(said, "Teach the check's diagnosis to recognise it, or correct the entry."),)
    return ()


def _result(verdict: Verdict, check_id: str) -> CheckResult | None:
    return next((check for check in verdict.checks if check.id == check_id), None)


def _first(mutant: Variant, verdict: Verdict) -> CheckResult | None:
    """The first check that caught it under its own name, else the first of its task that caught it."""
    failed = [one for one in verdict.checks if one.status is not Status.PASS and one.task == mutant.task]
    codes = (mutant.code, *mutant.also)
    named = (one for one in failed if (one.diagnosis or "") in codes)
    return next(named, failed[0] if failed else None)


# ---
# ``record.json`` beside the solution of an exercise: which check catches each wrong program, and what known
# wrong programs are told. A warm-up has few checks, and no record.


RECORD = "record.json"


class Reported(msgspec.Struct, frozen=True, array_like=True):
    """How often programs with these mistakes get this diagnosis.

    Attributes:
        codes: of the mistakes in them.
        said: diagnosis, "" for none, "survives" where no check fails.
    """

    task: str
    codes: tuple[str, ...]
    said: str
    count: int


class Record(msgspec.Struct, frozen=True, kw_only=True):
    """What came of the wrong programs of an exercise when it was last accepted.

    Attributes:
        made_from: digest of all that the rows follow from.
        caught: the id of the check that catches each program, by its name.
        rows: of all programs, at home ("public"), in a grading run ("full"), and in a run that knows
            no wrong program, where only the checks' probes can name a mistake ("alone").
    """

    made_from: str = ""
    caught: dict[str, str] = {}
    rows: dict[str, tuple[Reported, ...]] = {}


def record_path(catalog: Catalog, exercise: Exercise) -> Path:
    return solutions_folder(catalog, exercise) / RECORD


def read_record(catalog: Catalog, exercise: Exercise) -> Record | None:
    """The record of an exercise; None if it has none.

    Raises:
        ContentError: it is damaged.
    """
    path = record_path(catalog, exercise)
    try:
        return msgspec.json.decode(path.read_bytes(), type=Record) if path.is_file() else None
    except (OSError, msgspec.DecodeError) as error:
        fix = "Delete the file, then run `course author build --accept`."
        raise ContentError(path, None, f"it cannot be read: {error}.", help=fix) from None


def write_record(catalog: Catalog, exercise: Exercise, record: Record) -> Path:
    """Write the record beside the solution, one program or row a line."""
    path = record_path(catalog, exercise)
    text = msgspec.json.encode(record).decode().replace("],[", "],\n[").replace('","', '",\n"')
    write_atomically(path, f"{text}\n".encode())
    return path


def caught_by(catalog: Catalog, exercise: Exercise) -> dict[str, str]:
    """The id of the check that catches each wrong program, by its name; empty for a warm-up."""
    record = read_record(catalog, exercise)
    return record.caught if record else {}

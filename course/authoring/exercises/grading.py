"""The only interface between authoring and grading: the checks, and verdicts on sources."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import msgspec

from course.authoring.exercises.variants import solution_path
from course.catalog.load import Catalog
from course.catalog.reading import read_text
from course.grading.intake.students import Entry
from course.grading.running.batch import Graders
from course.grading.running.snapshot import Snapshot, frozen
from course.scoring.checks.collected import CollectedChecks
from course.scoring.explain.calls import reached_from
from course.scoring.judging.session import Submission, check_files
from course.scoring.judging.terms import Terms

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from course.catalog.models import Exercise
    from course.scoring.checks.collected import Check
    from course.scoring.verdict import Verdict

__all__ = ["GradeSources", "declared_checks", "grade_sources"]

#: How many gradings of small exercises take as long as starting one more process.
_WORTH_A_GRADER = 25

GradeSources: TypeAlias = "Callable[[Sequence[tuple[Exercise, bytes]]], Iterator[tuple[int, Verdict]]]"


def grade_sources(
    sources: Sequence[tuple[Exercise, bytes]], *, graders: int | None = None
) -> Iterator[tuple[int, Verdict]]:
    """Grade sources as a grading run does: by grader processes, from a snapshot of the course as it is now.

    The seed is fixed: the same files get the same verdicts, in any order. Most sources
    are the model solution with a few definitions after it. A check that uses none of the changed functions,
    directly or through others, has the same result as for the model, and is not run again.

    Args:
        sources: exercise and submission of each.
        graders: processes, at most; None for as many as are worth it.

    Yields:
        Index and verdict, in the order in which they are reached.

    Raises:
        CourseError: nothing can be graded here.
    """
    from course.engines.machine import this_machine

    if not sources:
        return
    if graders is None:
        graders = min(this_machine().cores, 1 + len(sources) // _WORTH_A_GRADER)
    catalog = Catalog()
    with (
        frozen(Snapshot.take(catalog.content)) as frozen_graders,
        Graders(Terms(graders=frozen_graders.snapshot.sha256), graders) as those,
    ):
        models = _models(catalog, dict.fromkeys(exercise for exercise, _ in sources), those)
        same: list[tuple[int, Verdict]] = []  # as the model solution, which is graded already

        def entries() -> Iterator[Entry]:
            for index, (exercise, source) in enumerate(sources):
                model, submission = models[exercise], Submission({exercise.module: source})
                if model.verdict and source.decode("utf-8", "replace").rstrip() == model.source:
                    same.append((index, model.verdict))
                else:
                    yield Entry(str(index), exercise, submission, only=model.concerned(source))

        for graded in those.grade(entries()):
            exercise, verdict = graded.entry.exercise, graded.verdict
            if graded.entry.only and verdict.state == "graded":
                verdict = models[exercise].completed(verdict, exercise)
            yield int(graded.entry.student), verdict
        yield from same


def _models(catalog: Catalog, exercises: Iterable[Exercise], graders: Graders) -> dict[Exercise, _Model]:
    """The model solution of each exercise, graded where that can save something."""
    models = dict.fromkeys(exercises, _Model())
    sources = {
        exercise: read_text(solution_path(catalog, exercise))
        for exercise in models
        if len(exercise.task) > 1  # where there is one function, every check asks for it
    }
    whole = [_model_entry(exercise, source) for exercise, source in sources.items()]
    for graded in graders.grade(whole):
        exercise, verdict = graded.entry.exercise, graded.verdict
        if verdict.state == "graded" and verdict.passed:
            asked = {check: frozenset(used) for check, used in graded.asked.items()}
            models[exercise] = _Model(sources[exercise].rstrip(), verdict, asked)
    # What an earlier check asked for and kept is asked for again where that check is not run.
    silent = [
        _model_entry(exercise, sources[exercise], checks)
        for exercise, model in models.items()
        if model.verdict is not None
        for task in exercise.task
        if (checks := model.silent(task.id))
    ]
    for graded in graders.grade(silent):
        used = frozenset(name for names in graded.asked.values() for name in names)
        models[graded.entry.exercise].asked.update(dict.fromkeys(graded.entry.only, used))
    return models


def _model_entry(exercise: Exercise, source: str, only: tuple[str, ...] = ()) -> Entry:
    return Entry("", exercise, Submission({exercise.module: source.encode()}), only=only, asks=True)


@dataclass(frozen=True, slots=True)
class _Model:
    """The model solution, its verdict, and the functions that each check used; empty if it is not graded."""

    source: str = ""
    verdict: Verdict | None = None
    asked: dict[str, frozenset[str]] = field(default_factory=dict)

    def silent(self, task: str) -> tuple[str, ...]:
        """Ids of a task's checks that used no function."""
        checks = self.verdict.checks if self.verdict else ()
        return tuple(check.id for check in checks if check.task == task and not self.asked[check.id])

    def concerned(self, source: bytes) -> tuple[str, ...]:
        """Ids of the checks that a source's changes can affect; empty means all."""
        changed = _changed(source.decode("utf-8", "replace"), self.source) if self.verdict else ()
        if not changed or self.verdict is None:
            return ()
        reach = reached_from(source, frozenset().union(*self.asked.values()))
        return tuple(
            check.id
            for check in self.verdict.checks
            if any(changed & {name, *reach.get(name, ())} for name in self.asked[check.id] or changed)
        )

    def completed(self, verdict: Verdict, exercise: Exercise) -> Verdict:
        """A verdict on the checks concerned, with the model's results for the others."""
        assert self.verdict is not None
        own = {check.id: check for check in verdict.checks}
        checks = tuple(own.get(check.id, check) for check in self.verdict.checks)
        score, most = sum(check.points for check in checks), self.verdict.max_score
        passed = score >= exercise.pass_mark * most - 1e-9  # as in GradingSession: only for rounding
        return msgspec.structs.replace(verdict, checks=checks, score=score, max_score=most, passed=passed)


def _changed(source: str, model: str) -> frozenset[str]:
    """The names that a source defines after the model solution; empty if it is not of that kind."""
    if not source.startswith(f"{model}\n"):
        return frozenset()
    try:
        tree = ast.parse(source.removeprefix(model))
    except (SyntaxError, ValueError):
        return frozenset()
    names: set[str] = set()
    for node in tree.body:
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                names.add(name)
            case ast.Assign() | ast.AnnAssign():
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                if not all(isinstance(target, ast.Name) for target in targets):
                    return frozenset()  # it reaches into something
                names |= {target.id for target in targets if isinstance(target, ast.Name)}
            case ast.Import() | ast.ImportFrom():
                names |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
            case ast.Expr(value=ast.Constant()):
                pass
            case _:
                return frozenset()
    return frozenset(names)


def declared_checks(exercise: Exercise, catalog: Catalog) -> dict[str, Check]:
    """The checks as pytest collects them, by id: markers whose values are computed have them here.

    Raises:
        ContentError: a file cannot be imported, or a check lacks its marks.
    """
    collected = CollectedChecks(check_files(exercise, catalog, "full"))
    try:
        return {check.id: check for check in collected.checks}
    finally:
        collected.close()

"""The only interface between authoring and grading: the checks, and verdicts on sources."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self, TypeAlias

import msgspec

from course.authoring.exercises.variants import solution_path
from course.catalog.load import Catalog
from course.catalog.reading import read_text
from course.grading.intake.students import Entry
from course.grading.running.batch import Graded, grade_all
from course.isolation.keeping import kept_sandboxes
from course.scoring.checks.collected import CollectedChecks
from course.scoring.explain.calls import reached_from
from course.scoring.judging.session import GradingSession, Submission, check_files
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


def grade_sources(sources: Sequence[tuple[Exercise, bytes]]) -> Iterator[tuple[int, Verdict]]:
    """Grade sources as a grading run would: a few in this process, more on every processor.

    The seed is fixed: the same files get the same verdicts, in any order. Most sources
    are the model solution with a few definitions after it. A check that uses none of the changed functions,
    directly or through others, has the same result as for the model, and is not run again.

    Args:
        sources: exercise and submission of each.

    Yields:
        Index and verdict, in the order in which they are reached.

    Raises:
        CourseError: nothing can be graded here.
    """
    from course.engines.machine import this_machine

    graders = min(this_machine().cores, 1 + len(sources) // _WORTH_A_GRADER)
    models: dict[str, _Model] = {}
    with kept_sandboxes(), _Sessions() as sessions:
        for exercise in {exercise.id: exercise for exercise, _ in sources}.values():
            if len(exercise.task) > 1:  # where there is one function, every check asks for it
                models[exercise.id] = _Model.graded(sessions, exercise)
            if graders > 1:
                sessions.close()
        entries = (
            Entry(
                str(index), exercise, Submission({exercise.module: source}),
                only=models[exercise.id].concerned(source) if exercise.id in models else (),
            )
            for index, (exercise, source) in enumerate(sources)
        )  # fmt: skip
        judged = sessions.grade(entries) if graders == 1 else grade_all(entries, Terms(), graders=graders)
        for graded in judged:
            verdict = graded.verdict
            if graded.entry.only and verdict.state == "graded":
                verdict = models[graded.entry.exercise.id].completed(verdict, graded.entry.exercise)
            yield int(graded.entry.student), verdict


class _Sessions:
    """A session of each exercise in this process, opened when first asked for."""

    def __init__(self) -> None:
        self.catalog = Catalog()
        self._open: dict[str, GradingSession] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def of(self, exercise: Exercise) -> GradingSession:
        if exercise.id not in self._open:
            self._open[exercise.id] = GradingSession(exercise, self.catalog, scope="full")
        return self._open[exercise.id]

    def grade(self, entries: Iterable[Entry]) -> Iterator[Graded]:
        for entry in entries:
            assert entry.submission is not None
            yield Graded(entry, self.of(entry.exercise).grade(entry.submission, only=entry.only))

    def close(self) -> None:
        for session in self._open.values():
            session.close()
        self._open.clear()


@dataclass(frozen=True, slots=True)
class _Model:
    """The model solution, its verdict, and the functions that each check used."""

    source: str
    verdict: Verdict
    asked: dict[str, frozenset[str]]

    @classmethod
    def graded(cls, sessions: _Sessions, exercise: Exercise) -> _Model:
        source = read_text(solution_path(sessions.catalog, exercise))
        session = sessions.of(exercise)
        verdict = session.grade(Submission({exercise.module: source.encode()}))
        return cls(source.rstrip(), verdict, dict(session.asked))

    def concerned(self, source: bytes) -> tuple[str, ...]:
        """Ids of the checks that a source's changes can affect; empty means all."""
        changed = _changed(source.decode("utf-8", "replace"), self.source)
        if not changed or self.verdict.state != "graded" or not self.verdict.passed:
            return ()
        reach = reached_from(source, frozenset().union(*self.asked.values()))
        return tuple(
            check.id
            for check in self.verdict.checks
            if any(changed & {name, *reach.get(name, ())} for name in self.asked.get(check.id) or changed)
        )

    def completed(self, verdict: Verdict, exercise: Exercise) -> Verdict:
        """A verdict on the checks concerned, with the model's results for the others."""
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

"""What is computed at the author's desk and shipped with an exercise: ``hypotheses.json``.

The wheel has no solutions. So that a diagnosis at home is as good as in a grading run, this writes what each
known wrong program answers to the questions of an exercise, as fingerprints, and what its public checks
expect for their fixed inputs. The audit refuses a file that is older than what it was made from.
"""

from __future__ import annotations

import copy
import hashlib
import math
from dataclasses import asdict, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from course.authoring.exercises.mutants import mutant_path
from course.authoring.exercises.variants import accepted_files, compose, solution_path, solutions_folder
from course.grading import kit
from course.scoring.explain.fingerprint import fingerprint, in_range
from course.scoring.explain.table import FILE, Row, Table, is_right, write_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from types import ModuleType

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["SOURCES", "build", "digest", "hypotheses_of", "table_of"]

#: Files of an exercise, and of its solution, that the table follows from.
SOURCES = (
    ("questions.py", "paths.py"),
    ("hypotheses.py", "formulas.py", "motions.py", "draws.py", "mutants.toml"),
)
#: Programs with two mistakes that are kept for a task: with more, a wheel would carry what nobody writes.
_MOST_PAIRS = 260


def build(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Write the table of an exercise; None if it has no hypotheses."""
    if not (solutions_folder(catalog, exercise) / "hypotheses.py").is_file():
        return None
    path = exercise.readme_path.with_name(FILE)
    write_table(path, table_of(catalog, exercise))
    return path


def digest(catalog: Catalog, exercise: Exercise) -> str:
    """Over all that the table of an exercise is computed from."""
    solutions = solutions_folder(catalog, exercise)
    own, theirs = SOURCES
    files = [exercise.readme_path.with_name(name) for name in own] + [solutions / name for name in theirs]
    files += [solution_path(catalog, exercise), *accepted_files(catalog, exercise)]
    files += sorted((solutions / "mutants").glob("*.py"))
    made_from = hashlib.sha256()
    for path in files:
        if path.is_file():
            made_from.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return made_from.hexdigest()[:16]


def table_of(catalog: Catalog, exercise: Exercise) -> Table:
    """The table of an exercise, computed anew."""
    questions = kit.companion(exercise.id, "questions")
    within: dict[str, float] = getattr(questions, "WITHIN", {})
    asked = {task: _Asked(args, within.get(task, 0.0)) for task, args in questions.QUESTIONS.items()}
    right = {
        task: tuple(sorted({ask.sums(fn) for fn in _right(catalog, exercise, task)}))
        for task, ask in asked.items()
    }
    made = Table(
        made_from=digest(catalog, exercise),
        within=within,
        right=right,
        answers=_plain(_expected(exercise)),
    )
    rows: dict[str, dict[tuple[float, ...], dict[tuple[str, ...], Row]]] = {task: {} for task in asked}
    for task, codes, function in hypotheses_of(catalog, exercise):
        sums = asked[task].sums(function)
        known = rows[task].setdefault(sums, {})
        if not is_right(made, task, sums) and not any(len(other) < len(codes) for other in known):
            known.setdefault(codes, Row(codes, sums))
    made.rows.update({task: _kept(some) for task, some in rows.items()})
    return made


def _kept(rows: dict[tuple[float, ...], dict[tuple[str, ...], Row]]) -> tuple[Row, ...]:
    """All programs with one mistake, and as many with two, spread evenly over what there is."""
    every = [row for known in rows.values() for row in known.values()]
    single = [row for row in every if len(row.codes) == 1]
    double = [row for row in every if len(row.codes) > 1]
    return (*single, *double[:: max(1, math.ceil(len(double) / _MOST_PAIRS))])


class _Asked:
    """The questions of one task."""

    def __init__(self, questions: list[tuple[Any, ...]], within: float) -> None:
        self._questions = questions
        self._within = within

    def sums(self, function: Callable[..., Any]) -> tuple[float, ...]:
        answers = [_answer(function, args) for args in self._questions]
        if not self._within:
            return fingerprint(answers)
        return tuple(float(f"{in_range(a):.5g}") if isinstance(a, int | float) else -1.0 for a in answers)


def _answer(function: Callable[..., Any], args: tuple[Any, ...]) -> Any:
    try:
        with np.errstate(all="ignore"):
            return function(*copy.deepcopy(args))
    except Exception as error:  # noqa: BLE001 - a wrong program may raise anything
        return {"raised": type(error).__name__}


def hypotheses_of(
    catalog: Catalog, exercise: Exercise
) -> Iterator[tuple[str, tuple[str, ...], Callable[..., Any]]]:
    """Task, codes and function of every known wrong program: the mutants, then ``hypotheses.py``."""
    solution = solution_path(catalog, exercise)
    for mutant in catalog.mutants(exercise):
        module = _executed(compose(solution, mutant_path(catalog, exercise, mutant)))
        yield mutant.task, (mutant.diagnosis,), module[mutant.task]
    reference: ModuleType | None = kit.reference(exercise.id, "hypotheses")
    if reference is not None:
        yield from reference.hypotheses()


def _right(catalog: Catalog, exercise: Exercise, task: str) -> Iterator[Callable[..., Any]]:
    solution = solution_path(catalog, exercise)
    yield _executed(solution.read_bytes())[task]
    for path in accepted_files(catalog, exercise):
        yield _executed(compose(solution, path))[task]


def _executed(source: bytes) -> dict[str, Any]:
    namespace: dict[str, Any] = {"__name__": "submission"}
    exec(compile(source, "<submission>", "exec", dont_inherit=True), namespace)
    return namespace


def _expected(exercise: Exercise) -> dict[str, Any]:
    """What the public checks expect for their fixed inputs, by check."""
    known: Callable[[], dict[str, Any]] | None = (
        getattr(kit.companion(exercise.id, "bundles"), "known", None)
        if (exercise.readme_path.with_name("bundles.py").is_file())
        else None
    )
    return known() if known else {}


def _plain(value: Any) -> Any:
    """Plain values that JSON has; infinities as text."""
    if is_dataclass(value) and not isinstance(value, type):
        return [_plain(item) for item in asdict(value).values()]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return str(value) if isinstance(value, float) and math.isinf(value) else value

"""``hypotheses.json``: computed on the author's machine, and part of the exercise.

The wheel has no solutions. So that a diagnosis at home is as good as in a grading run, this module writes the
answers of each known wrong program to the questions of an exercise, as fingerprints, and the expected values
of its public checks for their fixed inputs. The audit refuses a file that is older than what it was made
from.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import asdict, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from course.authoring.exercises.mutants import mutant_path
from course.authoring.exercises.unprotected import LocalSubmission
from course.authoring.exercises.variants import accepted_files, compose, solution_path, solutions_folder
from course.errors import ContentError
from course.grading import kit
from course.scoring.checks.companions import companion_path, words
from course.scoring.explain.fingerprint import numbers_of
from course.scoring.explain.table import FILE, Row, Table, is_right, write_table
from course.scoring.explain.words import FILE as WORDS
from course.scoring.judging.explaining import answer_numbers, answers, tasks_asked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from types import ModuleType

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["SOURCES", "build", "digest", "hypotheses_of", "sums_of", "table_of"]

#: Files of an exercise, and of its solution, that the table follows from.
SOURCES = (
    ("questions.py", "checking/paths.py"),
    ("hypotheses.py", "formulas.py", "motions.py", "draws.py", "mutants.toml"),
)
#: How many programs with two mistakes are kept for a task: students hardly write more, and the wheel would
#: grow.
_MOST_PAIRS = 260


def build(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Write the table of an exercise; None if its diagnoses have no words or there are no questions.

    Beside its mutants an exercise may have more wrong programs, in ``hypotheses.py``; a warm-up has none.
    """
    needed = exercise.readme_path.with_name(WORDS), companion_path(exercise.id, "questions")
    if not all(path.is_file() for path in needed):
        return None
    path = exercise.readme_path.with_name(FILE)
    write_table(path, table_of(catalog, exercise))
    return path


def digest(catalog: Catalog, exercise: Exercise) -> str:
    """A digest of everything that the table of an exercise is computed from."""
    solutions = solutions_folder(catalog, exercise)
    own, theirs = SOURCES
    files = [exercise.readme_path.parent / name for name in own] + [solutions / name for name in theirs]
    files += [solution_path(catalog, exercise), *accepted_files(catalog, exercise)]
    files += sorted((solutions / "mutants").glob("*.py"))
    made_from = hashlib.sha256()
    for path in files:
        if path.is_file():
            made_from.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return made_from.hexdigest()[:16]


def table_of(catalog: Catalog, exercise: Exercise) -> Table:
    """Compute the table of an exercise."""
    questions = kit.companion(exercise.id, "questions")
    within: dict[str, float] = getattr(questions, "WITHIN", {})
    tasks = sorted(tasks_asked(questions))
    for task in tasks:
        if task not in {task.id for task in exercise.task}:
            path = companion_path(exercise.id, "questions")
            raise ContentError(path, None, f"{task!r} is no function of the exercise.", help="Correct it.")
    right: dict[str, set[tuple[float, ...]]] = {}
    for task in tasks:
        for function in _right(catalog, exercise, task):
            for name, sums in sums_of(questions, task, function).items():
                right.setdefault(name, set()).add(sums)
    made = Table(
        made_from=digest(catalog, exercise),
        within=within,
        right={name: tuple(sorted(sums)) for name, sums in right.items()},
        answers=_plain(_expected(exercise)),
    )
    rows: dict[str, dict[tuple[float, ...], dict[tuple[str, ...], Row]]] = {name: {} for name in right}
    says = {task: _says(questions, task, next(_right(catalog, exercise, task))) for task in tasks}
    for task, codes, function in hypotheses_of(catalog, exercise):
        if len(codes) > 1 and 4 * _says(questions, task, function) < says[task]:
            continue
        for name, sums in sums_of(questions, task, function).items():
            known = rows[name].setdefault(sums, {})
            if not is_right(made, name, sums) and not any(len(other) < len(codes) for other in known):
                known.setdefault(codes, Row(codes, sums))
    made.rows.update({name: _kept(some) for name, some in rows.items()})
    return made


def _says(questions: ModuleType, task: str, function: Callable[..., Any]) -> int:
    """How many different numbers are among a function's answers.

    Two mistakes that leave hardly any, so that nothing is ever hit, would fit whatever else hits nothing.
    """
    calls = questions.QUESTIONS.get(task, ())
    local: Any = LocalSubmission("", replaced={task: function})
    return len({*numbers_of(answers(local, task, calls)).round(9)})


def _kept(rows: dict[tuple[float, ...], dict[tuple[str, ...], Row]]) -> tuple[Row, ...]:
    """All programs with one mistake, and a limited number with two, spread evenly over all of them."""
    every = [row for known in rows.values() for row in known.values()]
    single = [row for row in every if len(row.codes) == 1]
    double = [row for row in every if len(row.codes) > 1]
    return (*single, *double[:: max(1, math.ceil(len(double) / _MOST_PAIRS))])


def sums_of(questions: ModuleType, task: str, function: Callable[..., Any]) -> dict[str, tuple[float, ...]]:
    """A function's answers to the questions of its task, by name, if they are the same each time.

    A function that draws from its own generator gives different answers each time, so it cannot be
    recognised.
    """
    local: Any = LocalSubmission("", replaced={task: function})
    within = getattr(questions, "WITHIN", {}).get(task)
    found, again = (
        answer_numbers(questions, task, lambda calls: answers(local, task, calls), within) for _ in range(2)
    )
    return {
        name: numbers if within is None else tuple(float(f"{number:.5g}") for number in numbers)
        for name, numbers in found.items()
        if numbers == again[name]
    }


def hypotheses_of(
    catalog: Catalog, exercise: Exercise
) -> Iterator[tuple[str, tuple[str, ...], Callable[..., Any]]]:
    """Task, codes and function of every known wrong program: the mutants, then ``hypotheses.py``.

    Mutants whose diagnosis is not in the exercise's own words are left out: they are found while reading a
    value.

    Raises:
        ContentError: ``hypotheses.py`` has a program of no task of this exercise, or a code without words.
    """
    solution = solution_path(catalog, exercise)
    told = words(exercise.id).entries
    for mutant in (mutant for mutant in catalog.mutants(exercise) if mutant.diagnosis in told):
        module = _executed(compose(solution, mutant_path(catalog, exercise, mutant)))
        yield mutant.task, (mutant.diagnosis,), module[mutant.task]
    reference: ModuleType | None = None
    if (solutions_folder(catalog, exercise) / "hypotheses.py").is_file():
        reference = kit.reference(exercise.id, "hypotheses")
    if reference is not None:
        path, tasks = (
            solutions_folder(catalog, exercise) / "hypotheses.py",
            {task.id for task in exercise.task},
        )
        for task, codes, function in reference.hypotheses():
            if task not in tasks:
                raise ContentError(
                    path, None, f"{task!r} is no function of the exercise.", help="Correct it."
                )
            for code in codes:
                if code not in told:
                    raise ContentError(path, None, f"{WORDS} has no words for {code}.", help="Write them.")
            yield task, codes, function


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
    """The answers that public checks expect for their fixed inputs, by check."""
    known: Callable[[], dict[str, Any]] | None = (
        getattr(kit.companion(exercise.id, "bundles"), "known", None)
        if companion_path(exercise.id, "bundles").is_file()
        else None
    )
    return known() if known else {}


def _plain(value: Any) -> Any:
    """Plain values that JSON has, from which ``known_answers`` makes the same again; infinities as text."""
    if is_dataclass(value) and not isinstance(value, type):
        return [_plain(item) for item in asdict(value).values()]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, np.ndarray):
        return {"array": _plain(value.tolist())}
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        items = [_plain(item) for item in value]
        return {"tuple": items} if isinstance(value, tuple) else items
    return str(value) if isinstance(value, float) and math.isinf(value) else value

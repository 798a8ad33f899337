"""What a student's own machine says of wrong programs, where nothing answers for them.

A wheel has no references: the public checks with fixed inputs take what they expect from ``diagnoses.json``.
Each known wrong program is told the same there as beside the references.
"""

import math
from dataclasses import asdict, is_dataclass

import numpy as np
import pytest

from course.authoring.exercises.grading import mistakes_of, solution_path, source_of
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.scoring import kit
from course.scoring.explain.story import read_table
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import OURS

CATALOG = Catalog()
#: Ten thousand times what sums of some hundred doubles lose.
ROUNDING = {"rtol": 1e-10, "atol": 1e-12}
pytestmark = pytest.mark.usefixtures("sandboxes")
#: The exercises whose public checks know answers that their references give.
ANSWERED = [
    exercise.id
    for exercise in CATALOG.exercises()
    if (table := read_table(exercise.readme_path.parent)) and table.answers
]
#: Read while there are solutions: the tests take them away.
MUTANTS = {name: mistakes_of(CATALOG, CATALOG.exercise(name)).wrong for name in ANSWERED}


def _told(exercise_id, step):
    """What the checks of its task say of wrong programs, by file: of each ``step``-th of the tasks that have
    known answers.
    """
    exercise = CATALOG.exercise(exercise_id)
    solution = Submission({exercise.module: solution_path(CATALOG, exercise).read_bytes()})
    table = read_table(exercise.readme_path.parent)
    with GradingSession(exercise, CATALOG, scope="public", terms=Terms(home=True, timeout=5.0)) as session:
        checks = session.grade(solution).checks
        tasks = {check.task for check in checks if check.id in table.answers}
        told = {}
        for mutant in [one for one in MUTANTS[exercise_id] if one.task in tasks][::step]:
            source = Submission({exercise.module: source_of(CATALOG, exercise, mutant)})
            of_task = {check.id for check in checks if check.task == mutant.task}
            verdict = session.grade(source, only=of_task)
            told[mutant.name] = list(verdict.checks)
        return told


def _same(one, other):
    """Equal but for rounding, which differs from machine to machine, and of the same kinds all the way down.

    numpy's own numbers are as good as Python's.
    """
    if is_dataclass(one) and not isinstance(one, type):
        return _same(list(asdict(one).values()), other)
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, np.ndarray):
        alike = isinstance(other, np.ndarray) and one.shape == other.shape
        return alike and np.allclose(one, other, **ROUNDING)
    if isinstance(one, list | tuple):
        return type(one) is type(other) and len(one) == len(other) and all(map(_same, one, other))
    if isinstance(other, np.ndarray | list | tuple | dict):
        return False
    near = isinstance(other, float) and math.isclose(one, other, rel_tol=ROUNDING["rtol"])
    return near or bool(one == other)


@pytest.mark.parametrize("exercise_id", ANSWERED)
def test_a_known_answer_is_of_the_kind_that_the_reference_gives(exercise_id):
    for check, right in kit.companion(exercise_id, "bundles").known().items():
        for one, known in zip(right, kit.known_answers(exercise_id, check), strict=True):
            assert _same(one, known), (check, one, known)


@pytest.mark.parametrize("step", [4, pytest.param(1, marks=pytest.mark.soak)])
@pytest.mark.parametrize("exercise_id", ANSWERED)
def test_a_wrong_program_is_told_the_same_without_the_references(exercise_id, step, monkeypatch):
    beside = _told(exercise_id, step)
    monkeypatch.setattr(type(content()), "solution_folder", lambda _, __: None)
    assert kit.reference(exercise_id, "formulas") is None
    alone = _told(exercise_id, step)
    assert beside.keys() == alone.keys()
    assert beside
    for name in beside:
        for one, other in zip(beside[name], alone[name], strict=True):
            assert not (other.traceback or "").startswith(OURS), (name, other.traceback)
            assert (one.id, one.status, one.diagnosis, one.message, one.help) == (
                other.id,
                other.status,
                other.diagnosis,
                other.message,
                other.help,
            ), name

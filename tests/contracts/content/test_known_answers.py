"""What a student's own machine says of wrong programs, where nothing answers for them.

A wheel has no references: the public checks with fixed inputs take what they expect from ``diagnoses.json``.
Each known wrong program is told the same there as beside the references.
"""

from operator import attrgetter

import pytest

from course.authoring.exercises.diagnosis import _alike, _plain
from course.authoring.exercises.grading import mistakes_of, solution_path, source_of
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.scoring import kit
from course.scoring.explain.story import read_table
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import OURS

CATALOG = Catalog()
TOLD = attrgetter("id", "status", "diagnosis", "message", "help")
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
    """What the checks of its task say of each ``step``-th wrong program of tasks that have known answers."""
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
            told[mutant.name] = session.grade(source, only=of_task).checks
        return told


@pytest.mark.parametrize("exercise_id", ANSWERED)
def test_a_known_answer_is_of_the_kind_that_the_reference_gives(exercise_id):
    """And equal but for rounding, which differs from machine to machine."""
    for check, right in kit.companion(exercise_id, "bundles").known().items():
        known = kit.known_answers(exercise_id, check)
        assert _alike(_plain(right), _plain(known)), (check, right, known)
        assert "inf'" not in repr(known), "an infinity is a number again, and no text"


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
            assert TOLD(one) == TOLD(other), name

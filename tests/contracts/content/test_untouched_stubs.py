"""A stub that nobody has touched is work to do, whatever its functions return; a touched one is judged."""

import pytest

from course.catalog.load import Catalog
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Status

CATALOG = Catalog()


@pytest.mark.parametrize("name", CATALOG.exercise_ids())
def test_nothing_of_an_untouched_stub_fails(name):
    exercise = CATALOG.exercise(name)
    files = {exercise.module: exercise.stub_path.read_bytes()}
    with GradingSession(exercise, CATALOG, scope="public", terms=Terms(home=True)) as session:
        verdict = session.grade(Submission(files))
    told = {check.diagnosis for check in verdict.checks if check.status is not Status.SKIP}
    assert told == {"NOT_IMPLEMENTED"}
    assert verdict.score == 0.0


def test_a_function_is_judged_once_it_or_what_it_uses_has_changed():
    exercise = CATALOG.exercise("collisions")
    stub = exercise.stub_path.read_text("utf-8")
    touched = stub.replace("int(t_end / h)", "round(t_end / h)", 1)
    assert touched != stub
    with GradingSession(exercise, CATALOG, scope="public", terms=Terms(home=True)) as session:
        verdict = session.grade(Submission({exercise.module: touched.encode()}))
        helped = stub.replace("import numpy as np\n", "import numpy as np\n\nrange = reversed\n", 1)
        other = session.grade(Submission({exercise.module: helped.encode()}))
    for given in (verdict, other):
        judged = {check.task for check in given.checks if check.diagnosis != "NOT_IMPLEMENTED"}
        assert "simulate_head_on" in judged

"""Whatever students and Jupyter do to a notebook's cells: the same code gets the same score."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.handed_in.notebook import RECORD, NotebookSource, notebook_source, opened
from course.physics import systems
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission
from tests.unit.notebooks.edits import edited

STEPS = ("explicit_euler_step", "semi_implicit_euler_step", "velocity_verlet_step", "rk4_step")


def handed_in(module: NotebookSource, exercise: Exercise) -> Submission:
    """A notebook as a grading run reads it back."""
    return opened({exercise.module: module.source, RECORD: module.record()}, exercise)


def behaviour(source: bytes) -> list[Any]:
    """What the functions of a module give, to the last bit."""
    names: dict[str, Any] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about escapes and the like in strings
        exec(compile(source, "integrators.py", "exec", dont_inherit=True), names)
    system = systems.Oscillator(omega=2.0)
    start = np.array([1.0]), np.array([0.5])
    runs = [names["integrate"](names[step], system, *start, 0.5, 0.1) for step in STEPS]
    times = names["integrate"](names["rk4_step"], system, *start, 0.5, 0.05)[0]
    return [np.concatenate([q.ravel(), v.ravel()]).tobytes() for _, q, v in runs] + [times.tobytes()]


@pytest.mark.parametrize("first", range(0, 500, 125))
def test_500_random_edits_leave_the_code_what_it_was(
    solved: bytes, solution: str, integrators: Exercise, first: int
) -> None:
    right = behaviour(solution.encode())
    for seed in range(first, first + 125):
        module = notebook_source(edited(solved, seed), integrators)
        assert behaviour(module.source) == right, f"seed {seed}"


@pytest.mark.parametrize("function", STEPS)
def test_a_wrong_function_stays_wrong(
    solved: bytes, solution: str, integrators: Exercise, function: str
) -> None:
    """The comparison above can fail."""
    wrong = f"{solution}\n\ndef {function}(accel, t, q, v, h):\n    return q + h * v, v\n"
    assert behaviour(wrong.encode()) != behaviour(notebook_source(solved, integrators).source)


def test_the_same_code_scores_the_same_as_a_file_and_as_a_notebook(
    solved: bytes, solution: str, integrators: Exercise, catalog: Catalog
) -> None:
    """Some of its checks pass and some fail."""
    right, wrong = "h / 6 * (dq1", "h / 5 * (dq1"
    assert right in solution
    with GradingSession(integrators, catalog, scope="full") as session:
        as_file = session.grade(Submission({"integrators.py": solution.replace(right, wrong).encode()}))
        assert 0 < as_file.score < integrators.max_points
        for seed in (1, 2):
            edits = edited(solved.replace(right.encode(), wrong.encode()), seed)
            module = notebook_source(edits, integrators)
            as_notebook = session.grade(handed_in(module, integrators))
            assert as_notebook.score == as_file.score
            statuses = [[check.status for check in one.checks] for one in (as_notebook, as_file)]
            assert statuses[0] == statuses[1]
            assert as_notebook.warnings == module.notes


def test_an_error_in_a_notebook_is_told_by_its_cell(
    solved: bytes, integrators: Exercise, catalog: Catalog
) -> None:
    raising = solved.replace(b"return q + h * v, v + h * accel(t, q, v)", b"return q / (0 * h).nothing")
    assert raising != solved
    module = notebook_source(raising, integrators)
    with GradingSession(integrators, catalog) as session:
        verdict = session.grade(handed_in(module, integrators))
        line = next(n for n, text in enumerate(module.source.decode().split("\n"), 1) if "nothing" in text)
        check = next(check for check in verdict.checks if check.task == "explicit_euler_step")
        assert f"in {module.place(line)} of your notebook" in check.message
        assert (check.traceback or "").startswith(f"{module.place(line)} in explicit_euler_step")
        syntax = notebook_source(solved.replace(b"return q + h * v, v", b"return q + * h, v"), integrators)
        broken = session.grade(handed_in(syntax, integrators))
    assert broken.state == "graded"
    assert {check.task for check in broken.checks if check.status != "pass"} == {"explicit_euler_step"}
    (check,) = [one for one in broken.checks if one.id == check.id]
    assert check.message.startswith("Python cannot read `explicit_euler_step` in cell ")
    assert broken.warnings[0].startswith("Cell ")

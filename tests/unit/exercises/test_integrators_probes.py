"""Where the probes of ``integrators`` must not speak, and what has no points.

What known wrong programs are told is in ``solutions/integrators/record.json``, which the audit keeps.
"""

import math

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.catalog.load import Catalog
from course.physics import systems
from course.scoring import kit
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission

probes = kit.companion("integrators", "probes")
cases = kit.companion("integrators", "cases")
formulas = kit.reference("integrators", "formulas")


def program(**functions):
    """A submission of these functions; others are still to be written."""
    return LocalSubmission("", replaced=functions)


def raises(error):
    """A function that ends in this exception."""

    def function(*args):
        raise error

    return function


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_a_right_formula_is_given_no_code_and_one_in_single_precision_is_told_so(task):
    for right in formulas.RIGHT[task]:

        def single(accel, t, q, v, h, right=right):
            return [np.asarray(part, np.float32).astype(float) for part in right(accel, t, q, v, h)]

        assert probes.of_step(program(**{task: right}), task) is None
        assert probes.of_step(program(**{task: single}), task).code == "FEW_DIGITS"


def test_a_named_mistake_says_where_the_path_leaves_the_right_one():
    problem = (systems.ForcedOscillator(2.0, 1.5, 3.1), [0.8], [-0.9], 0.9 / 16, 16, 0.4)
    frozen = formulas._at(formulas.RIGHT["velocity_verlet_step"][0], 0)
    found = probes.of_step(program(velocity_verlet_step=frozen), "velocity_verlet_step", problem)
    assert (found.divergence.quantity, found.divergence.step) == ("v[0]", 1)


@pytest.mark.parametrize("order", ["qvt", "qtv", "vtq"])
def test_results_in_another_order_are_told_by_where_the_times_stand(order):
    parts = {"t": np.arange(3.0), "q": np.ones((3, 2)), "v": np.zeros((3, 2))}
    with pytest.raises(kit.CheckFailed) as failed:
        cases.histories(tuple(map(parts.get, order)))
    assert failed.value.finding.diagnosis == "TIMES_NOT_FIRST"


def test_a_refusal_by_another_exception_is_no_crash_and_a_slip_no_refusal():
    ones = np.ones(1)
    with pytest.raises(kit.CheckFailed) as failed:
        cases.expect_refusals(program(integrate=raises(RuntimeError)), (ones, ones), [(1.1, 0.2)])
    assert failed.value.finding.diagnosis == "OTHER_EXCEPTION"
    with pytest.raises(kit.StudentFailure):
        cases.expect_refusals(program(integrate=raises(IndexError)), (ones, ones), [(1.1, 0.2)])


def integrate(step, accel, q0, v0, t_end, h):
    """The right number of rows, and nothing in them."""
    t = h * np.arange(max(1, round(t_end / h)) + 1)
    return t, np.zeros((len(t), 1)), np.zeros((len(t), 1))


COUNTS, ONES = program(integrate=integrate), np.ones(1, dtype=int)
#: Programs of one function that always fails.
STEPS, REFUSES = program(rk4_step=raises(RuntimeError)), program(integrate=raises(ValueError))
ORDER = program(observed_order=lambda hs, errors: 0.5)
HS, T = np.array([0.2, 0.11, 0.04, 0.03]), np.arange(6.0)
Q, V = np.column_stack([np.cos(T), np.sin(T) + 2]) / 9, np.column_stack([T - 2.5, T**2])
WITHOUT_ROW_2 = [np.where(np.arange(6)[:, None] == 2, 0.0, rows) for rows in (Q, V)]


@pytest.mark.parametrize(
    ("find", "code"),
    [
        (lambda: probes.of_energy(STEPS, "rk4_step", math.nan, 0.2), None),
        (lambda: probes.of_swing(STEPS, "rk4_step", math.nan, 0.2), None),
        # An error of NumPy's, whatever the duration and the numbers, is no refusal.
        (lambda: probes.of_refusal(REFUSES, ONES, ONES, 0.29), None),
        (lambda: probes.of_whole_start(REFUSES, [None, None, ONES, ONES, 1.0, 0.25]), None),
        # Where nothing is rounded, rounding is not what is missing.
        (lambda: probes.of_count(COUNTS, 0, 0.1, T), None),
        (lambda: probes.of_count(COUNTS, 8, 0.25, T), None),
        (lambda: probes.of_count(COUNTS, 8, 0.1, T), "COUNT_NOT_ROUNDED"),
        (lambda: probes.of_count(COUNTS, 5, 0.25, None), None),
        (lambda: probes.of_rows(T, Q[[0] * 6], V, 1.0, (Q, V)), "ROW_OF_Q_WRONG"),
        (lambda: probes.of_rows(T, Q, V[[0] * 6], 1.0, (Q, V)), "ROW_OF_V_WRONG"),
        (lambda: probes.of_rows(T, Q[[0, *[5] * 5]], V[[0, *[5] * 5]], 1.0, (Q, V)), None),
        (lambda: probes.of_rows(T, *WITHOUT_ROW_2, 1.0, (Q, V)), None),
        (lambda: probes.of_rows(T, Q, V, 1.0, (Q, V)), None),
        # Positions that are all zero are whole numbers, and may have been left out.
        (lambda: probes.of_rows(T, 0 * Q, V, 1.0, (Q, V)), "INITIAL_STATE_MISSING"),
        (lambda: probes.of_order(ORDER, 2.3, HS, HS**-2.3), "SLOPE_WITHOUT_SIGN"),
        (lambda: probes.of_order(ORDER, 2.346, HS, HS**2.34567), "SLOPE_NEARLY_RIGHT"),
        # Another way of fitting may come near the right slope where the points scatter.
        (lambda: probes.of_order(ORDER, 2.346, HS, HS**2.34567 * [1.0, 1.01, 1.01, 1.0]), None),
    ],
)
def test_no_more_is_said_than_what_was_found_shows(find, code):
    found = find()
    assert (found and found.code) == code


def test_steps_that_make_the_right_calls_and_return_nothing_have_no_points():
    once = "def {}(accel, t, q, v, h):\n    accel(t, q, v)\n"
    source = "".join(map(once.format, formulas.RIGHT)) + "    accel(t, q, v)\n" * 3  # RK4, the last, has four
    catalog = Catalog()
    with GradingSession(catalog.exercise("integrators"), catalog, scope="full") as session:
        assert session.grade(Submission({"integrators.py": source.encode()})).score == 0.0

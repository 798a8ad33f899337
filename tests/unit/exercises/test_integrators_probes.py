"""Where the probes of ``integrators`` must not speak, and its report against closed forms.

What known wrong programs are told is in ``solutions/integrators/record.json``, which the audit keeps.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.catalog.load import Catalog
from course.figures.plots import render
from course.physics import systems
from course.scoring import kit
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission

probes = kit.companion("integrators", "probes")
cases = kit.companion("integrators", "cases")
report = kit.companion("integrators", "report")
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
    assert found.code == "STAGE_TIMES_FROZEN"
    assert (found.divergence.quantity, found.divergence.step) == ("v[0]", 1)


def test_a_time_for_each_coordinate_is_in_its_place():
    def euler(accel, t, q, v, h):
        return q + h * v, v + h * h * np.asarray(accel(t * np.ones_like(q), q, v))

    assert not probes._mixes_arguments(program(explicit_euler_step=euler), "explicit_euler_step")


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


def _without(row, *histories):
    """Histories whose row holds nothing but zeros."""
    return [np.where(np.arange(6)[:, None] == row, 0.0, rows) for rows in histories]


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
        (lambda: probes.of_count(COUNTS, 5, 0.1, Q), "TIMES_NOT_AS_ROWS"),
        (lambda: probes.of_count(COUNTS, 5, 0.25, None), None),
        (lambda: probes.of_rows(T, Q[[0] * 6], V, 1.0, (Q, V)), "ROW_OF_Q_WRONG"),
        (lambda: probes.of_rows(T, Q, V[[0] * 6], 1.0, (Q, V)), "ROW_OF_V_WRONG"),
        (lambda: probes.of_rows(T, Q[[0, *[5] * 5]], V[[0, *[5] * 5]], 1.0, (Q, V)), None),
        (lambda: probes.of_rows(T, *_without(1, Q, V), 1.0, (Q, V)), "FIRST_STEP_MISSING"),
        (lambda: probes.of_rows(T, *_without(2, Q, V), 1.0, (Q, V)), None),
        (lambda: probes.of_rows(T, Q, np.round(V / 3, 7), 1.0, (Q, V / 3)), "ROWS_HAVE_FEW_DIGITS"),
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


def _limit(matrix, most=1 + 1e-8):
    """A search that is right but for the matrix that it makes of the step's, and for what it allows."""

    def largest(step, omega):
        z = np.arange(0.05, 10.05, 0.005)
        steady = abs(np.linalg.eigvals(matrix(step.matrix(z), omega))).max(axis=-1) <= most
        return z[np.argmin(steady) - 1] / omega if steady[0] else 0.0

    return largest


@pytest.mark.parametrize(
    ("search", "code"),
    [
        (_limit(lambda m, omega: m, 1 - 1e-12), "TOLERANCE_TOO_TIGHT"),
        (_limit(lambda m, omega: m * np.array([[1, omega], [1, 1]])), "LIMIT_TOO_EARLY"),
        (_limit(lambda m, omega: m[..., ::-1]), "LIMIT_TOO_EARLY"),
    ],
    ids=["strict", "not scaled", "columns swapped"],
)
def test_a_strict_limit_is_told_from_a_wrong_matrix(search, code):
    verlet = systems.LinearStep([1, 0, -0.5], [0, 1], [0, -1, 0, 0.25], [1, 0, -0.5])
    found = probes.of_stability(program(max_stable_step=search), search(verlet, 4.0), verlet, 4.0, 2.0)
    assert found.code == code


RIGHT = {task: formulas.RIGHT[task][0] for task in report.STEPS}


def test_the_report_shows_the_orders_and_limits_of_right_steps():
    _, energy, order, stability = report.report(program(**RIGHT)).sections
    assert [float(row[1]) for row in order.rows] == pytest.approx([1, 1, 2, 4], abs=0.1)
    # Closed forms: none, 2, 2 and 2 sqrt(2); the steps tried are 0.02 apart.
    limits = [row[1] for row in stability.rows]
    assert limits[0] == "the smallest tried"
    assert [float(limit) for limit in limits[1:]] == pytest.approx([2, 2, 2 * 2**0.5], abs=0.02)
    # From rest Verlet's energy swings by z^2/4, semi-implicit Euler's by z/(2 - z), at z = 0.5.
    ends = {row[0]: float(row[-1]) for row in energy.rows}
    assert ends["velocity Verlet"] == pytest.approx(0.0625, rel=0.01)
    assert ends["semi-implicit Euler"] == pytest.approx(1 / 3, rel=0.01)


def test_the_report_measures_the_student_s_own_step_and_names_what_is_missing():
    """Verlet in the place of RK4 has its order. Whoever reads the report's file finds no step in it."""
    sections = report.report(program(rk4_step=RIGHT["velocity_verlet_step"])).sections
    assert float(sections[2].rows[0][1]) == pytest.approx(2, abs=0.1)
    for section in sections:
        assert [row[0] for row in section.rows] == ["Runge-Kutta 4"]
        assert section.text.count("\n- ") == 3
        assert "velocity Verlet: " in section.text
    assert all(section.plot is None for section in report.report(program()).sections)
    assert not {"integrators", "RK4"} & vars(report).keys()


@pytest.mark.parametrize("factor", [0, 1, np.nan, 1e200], ids=["vanishes", "still", "nan", "explodes"])
def test_the_report_draws_any_step(factor):
    def step(accel, t, q, v, h):
        return q * factor, v * min(factor, 1)

    for section in report.report(program(explicit_euler_step=step)).sections:
        assert section.rows
        assert render(section.plot).startswith(b"\x89PNG")


def test_steps_that_make_the_right_calls_and_return_nothing_have_no_points():
    calls = {
        "explicit_euler_step": 1,
        "semi_implicit_euler_step": 1,
        "velocity_verlet_step": 1,
        "rk4_step": 4,
    }
    source = "".join(
        f"def {name}(accel, t, q, v, h):\n    for _ in range({count}):\n        accel(t, q, v)\n"
        for name, count in calls.items()
    )
    catalog = Catalog()
    with GradingSession(catalog.exercise("integrators"), catalog, scope="full") as session:
        assert session.grade(Submission({"integrators.py": source.encode()})).score == 0.0

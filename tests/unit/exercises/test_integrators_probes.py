"""The probes of ``integrators``: what they say is what the step, the loop or the instrument does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.physics import systems
from course.scoring import kit

probes = kit.companion("integrators", "probes")
cases = kit.companion("integrators", "cases")
formulas = kit.reference("integrators", "formulas")


class Fake:
    """A submission that consists of the given functions."""

    def __init__(self, **functions):
        self._functions = functions

    def call(self, name, *args):
        return self._functions[name](*args)

    def call_each(self, name, calls):
        return [self.call(name, *args) for args in calls]

    def march(self, name, system, q0, v0, h, n, t0=0.0):
        q, v = [np.array(q0, float)], [np.array(v0, float)]
        for i in range(n):
            q_next, v_next = self._functions[name](system, t0 + i * h, q[-1], v[-1], h)
            q.append(q_next)
            v.append(v_next)
        return t0 + h * np.arange(n + 1), np.array(q), np.array(v)

    def march_each(self, name, marches):
        return [self.march(name, *march) for march in marches]


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_a_right_formula_is_given_no_code(task):
    for step in formulas.RIGHT[task]:
        assert probes.of_step(Fake(**{task: step}), task) is None


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_of_a_step_that_gives_nan_nothing_else_is_said(task):
    def step(accel, t, q, v, h):
        return np.full(np.shape(q), np.nan), v

    assert probes.of_step(Fake(**{task: step}), task) is None


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_single_precision_is_told_from_a_wrong_formula(task):
    def single(accel, t, q, v, h):
        right = formulas.RIGHT[task][-1](accel, t, q, v, h)
        return [np.asarray(part, np.float32).astype(float) for part in right]

    assert probes.of_step(Fake(**{task: single}), task).code == "FEW_DIGITS"


@pytest.mark.parametrize("order", [(1, 2, 0), (1, 0, 2), (2, 0, 1)])
def test_histories_in_another_order_are_told_by_where_the_times_stand(order):
    parts = np.arange(3.0), np.ones((3, 2)), np.zeros((3, 2))
    with pytest.raises(kit.CheckFailed) as failed:
        cases.histories(tuple(parts[i] for i in order))
    assert failed.value.finding.diagnosis == "TIMES_NOT_FIRST"
    assert list(map(np.ndim, cases.histories(parts))) == [1, 2, 2]


@pytest.mark.parametrize(
    ("limit", "code"), [(0.0, "NONE_FOR_ZERO"), (math.inf, "NONE_FOR_INFINITY"), (2.0, "NONE_FOR_LIMIT")]
)
def test_none_for_a_largest_step_is_told_beside_what_it_stands_for(limit, code):
    with pytest.raises(kit.CheckFailed) as failed:
        cases.expect_limit(None, None, (None, 1.0, limit), input={}, message="Wrong.")
    assert failed.value.finding.diagnosis == code


def test_a_refusal_by_another_exception_is_no_crash():
    def raises(name):
        def integrate(*args):
            raise kit.StudentFailure("error", type=name)

        return Fake(integrate=integrate)

    state, durations = (np.ones(1), np.zeros(1)), [(1.1, 0.2)]
    with pytest.raises(kit.CheckFailed) as failed:
        cases.expect_refusals(raises("RuntimeError"), state, durations)
    assert failed.value.finding.diagnosis == "OTHER_EXCEPTION"
    with pytest.raises(kit.StudentFailure):
        cases.expect_refusals(raises("IndexError"), state, durations)


def test_a_named_mistake_says_where_the_path_leaves_the_right_one():
    problem = (systems.ForcedOscillator(2.0, 1.5, 3.1), [0.8], [-0.9], 0.9 / 16, 16, 0.4)
    frozen = formulas._at(formulas.RIGHT["velocity_verlet_step"][0], 0)
    found = probes.of_step(Fake(velocity_verlet_step=frozen), "velocity_verlet_step", problem)
    assert found.code == "STAGE_TIMES_FROZEN"
    assert (found.divergence.quantity, found.divergence.step) == ("v[0]", 1)


def nothing(*args):
    raise kit.StudentFailure("error", type="RuntimeError", message="")


@pytest.mark.parametrize(
    ("change", "expected", "code"),
    [
        (0.3, 0.2, "ENERGY_GROWS"),
        (0.1, -0.2, "ENERGY_GROWS"),
        (0.1, 0.2, "ENERGY_GROWS_TOO_LITTLE"),
        (-0.1, 0.2, "ENERGY_FADES"),
        (-0.3, -0.2, "ENERGY_FADES"),
        (-0.1, -0.2, "ENERGY_FADES_TOO_LITTLE"),
    ],
)
def test_how_the_energy_changes_is_said_as_it_is(change, expected, code):
    fake = Fake(rk4_step=nothing)
    assert probes.of_energy(fake, "rk4_step", change, expected).code == code


def test_an_energy_that_swings_is_not_said_to_grow_or_to_fade():
    fake = Fake(rk4_step=nothing)
    assert probes.of_swing(fake, "rk4_step", 0.3, 0.2).code == "ENERGY_SWINGS_TOO_FAR"
    assert probes.of_swing(fake, "rk4_step", 0.1, 0.2).code == "ENERGY_SWINGS_TOO_LITTLE"


def test_of_an_energy_that_is_not_a_number_nothing_is_said():
    fake = Fake(rk4_step=nothing)
    assert probes.of_energy(fake, "rk4_step", math.nan, 0.2) is None
    assert probes.of_swing(fake, "rk4_step", math.nan, 0.2) is None


def test_a_limit_is_too_late_too_early_or_nearly_right():
    sides = {1.9: "SEARCH_TOO_COARSE", 3.0: "LIMIT_TOO_LATE", 1.2: "LIMIT_TOO_EARLY"}
    assert {z: probes._beside(z, 2.0) for z in sides} == sides
    assert probes._beside(1.0, 0.0) == "NO_ZERO"
    assert probes._beside(-1.0, 0.0) is None
    assert probes._beside(0.0, 0.2) == "LIMIT_TOO_EARLY"  # none of it is nearly all of it


def test_a_time_for_each_coordinate_is_in_its_place():
    def euler(accel, t, q, v, h):
        return q + h * v, v + h * h * np.asarray(accel(t * np.ones_like(q), q, v))

    assert not probes._mixes_arguments(Fake(explicit_euler_step=euler), "explicit_euler_step")


def test_a_numpy_error_is_no_refusal_of_a_duration():
    def integrate(step, accel, q0, v0, t_end, h):
        raise kit.StudentFailure("error", type="ValueError")

    raising = Fake(integrate=integrate)
    assert probes.of_refusal(raising, np.ones(1), np.ones(1), 0.29) is None
    assert probes.of_whole_start(raising, [None, None, np.array([1]), np.array([1]), 1.0, 0.25]) is None


def test_a_count_is_called_not_rounded_only_where_something_is_rounded():
    def integrate(step, accel, q0, v0, t_end, h):
        n = max(1, round(t_end / h))
        return [h * np.arange(n + 1), np.zeros((n + 1, 1)), np.zeros((n + 1, 1))]

    found = [probes.of_count(Fake(integrate=integrate), n, h) for n, h in ((0, 0.1), (8, 0.25), (8, 0.1))]
    assert [one and one.code for one in found] == [None, None, "COUNT_NOT_ROUNDED"]


SAMPLES = np.arange(6.0)
TRUE = np.column_stack([np.cos(SAMPLES), np.sin(SAMPLES) + 2]), np.column_stack([SAMPLES - 2.5, SAMPLES**2])


def _without(rows, value=0.0):
    """The rows with another first one."""
    return np.vstack([np.full(2, value), rows[1:]])


@pytest.mark.parametrize(
    ("code", "rows"),
    [
        ("HISTORIES_SWAPPED", lambda q, v: (v, q)),
        ("HISTORIES_IDENTICAL", lambda q, v: (v, v)),
        ("HISTORIES_IDENTICAL", lambda q, v: (q + 1, q + 1)),
        ("INITIAL_STATE_MISSING", lambda q, v: (0 * q, 0 * v)),
        ("INITIAL_STATE_MISSING", lambda q, v: (_without(q), v)),
        ("INITIAL_STATE_MISSING", lambda q, v: (q, _without(v))),
        ("INITIAL_STATE_MISSING", lambda q, v: (np.roll(q, -1, axis=0), np.roll(v, -1, axis=0))),
        ("INITIAL_STATE_WRONG", lambda q, v: (_without(q, 7.0), v)),
        ("INITIAL_STATE_WRONG", lambda q, v: (q, -v)),
        ("INTEGER_STATE", lambda q, v: (np.trunc(q), np.trunc(v))),
        ("STATE_NOT_CARRIED", lambda q, v: (q[[0, 1, 1, 1, 1, 1]], v[[0, 1, 1, 1, 1, 1]])),
        ("PATH_STANDS_STILL", lambda q, v: (q[[0] * 6], v[[0] * 6])),
        ("ROW_OF_Q_WRONG", lambda q, v: (q[[0] * 6], v)),
        ("ROW_OF_V_WRONG", lambda q, v: (q, v[[0] * 6])),
        (None, lambda q, v: (q[[0, 5, 5, 5, 5, 5]], v[[0, 5, 5, 5, 5, 5]])),
        (None, lambda q, v: (q, v)),
    ],
)
def test_rows_that_are_wrong_are_described_as_they_are(code, rows):
    found = probes.of_rows(0.1 * SAMPLES, *rows(*TRUE), 0.1, TRUE)
    assert (found and found.code) == code


def test_positions_that_are_all_zero_are_called_whole_numbers_only_if_velocities_are():
    small = TRUE[0] / 9, TRUE[1]
    assert probes.of_rows(0.1 * SAMPLES, 0 * small[0], small[1], 0.1, small).code == "INITIAL_STATE_MISSING"
    assert probes.of_rows(0.1 * SAMPLES, *map(np.trunc, small), 0.1, small).code == "INTEGER_STATE"


def test_times_that_begin_late_beside_the_right_states_are_told_from_a_missing_start():
    assert probes.of_rows(0.1 * SAMPLES + 0.1, *TRUE, 0.1, TRUE).code == "TIMES_START_LATE"
    late = [np.roll(rows, -1, axis=0) for rows in TRUE]
    assert probes.of_rows(0.1 * SAMPLES + 0.1, *late, 0.1, TRUE).code == "INITIAL_STATE_MISSING"


HS = np.array([0.2, 0.11, 0.04, 0.03])
ERRORS = np.array([0.9, 0.31, 0.04, 0.015])


def slope(x, y):
    return np.polyfit(x, y, 1)[0]


@pytest.mark.parametrize(
    ("code", "errors", "wrong"),
    [
        ("SLOPE_WITHOUT_SIGN", 1 / ERRORS, lambda x, y: abs(slope(x, y))),
        ("SLOPE_NEARLY_RIGHT", 2.0 * HS**2.34567, lambda x, y: round(slope(x, y), 3)),
        # Another way of fitting may come near the right slope where the points scatter.
        (None, ERRORS, lambda x, y: slope(x, y) * 1.0001),
    ],
)
def test_a_slope_without_its_sign_or_last_digits_is_told_so(code, errors, wrong):
    fake = Fake(observed_order=lambda hs, errors: float(wrong(np.log(hs), np.log(errors))))
    found = probes.of_order(fake, fake.call("observed_order", HS, errors), HS, errors)
    assert (found and found.code) == code

"""The probes of ``integrators``: what they say is what the step, the loop or the instrument does."""

from __future__ import annotations

import contextlib
import itertools
import math
from pathlib import Path

import numpy as np
import pytest

from course.physics import systems
from course.scoring import kit
from course.scoring.explain.story import matching, read_table
from course.scoring.judging.explaining import answer_numbers

ROOT = Path(__file__).resolve().parents[3]
probes = kit.companion("integrators", "probes")
cases = kit.companion("integrators", "cases")
questions = kit.companion("integrators", "questions")
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


@pytest.mark.parametrize("divisor", [1, 2, 3, 4, 5, 7, 8, 12])
def test_weights_that_do_not_add_up_are_recognised_whatever_they_are(divisor):
    step = formulas._runge_kutta(weights=tuple(w / divisor for w in (1, 2, 2, 1)))
    assert probes.of_step(Fake(rk4_step=step), "rk4_step").code == "WEIGHTS_DO_NOT_ADD_UP"


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_of_a_step_that_gives_nan_nothing_else_is_said(task):
    def step(accel, t, q, v, h):
        return np.full(np.shape(q), np.nan), v

    assert probes.of_step(Fake(**{task: step}), task) is None


def test_frozen_times_are_recognised_in_a_runge_kutta_method_of_another_form():
    def three_eighths_without_clock(accel, t, q, v, h):
        def f(q, v):
            return np.array([v, accel(t, q, v)])

        y = np.array([q, v])
        k1 = f(*y)
        k2 = f(*(y + h / 3 * k1))
        k3 = f(*(y + h * (k2 - k1 / 3)))
        k4 = f(*(y + h * (k1 - k2 + k3)))
        return tuple(y + h / 8 * (k1 + 3 * k2 + 3 * k3 + k4))

    fake = Fake(rk4_step=three_eighths_without_clock)
    assert probes.of_step(fake, "rk4_step").code == "STAGE_TIMES_FROZEN"


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_an_unknown_formula_is_described_by_how_it_converges():
    def off_by_a_tenth(accel, t, q, v, h):
        q_next, v_next = formulas.RIGHT["rk4_step"][0](accel, t, q, v, h)
        return q_next + 0.1 * h * v, v_next

    def ralston(accel, t, q, v, h):
        a = accel(t, q, v)
        b = accel(t + 2 * h / 3, q + 2 * h / 3 * v, v + 2 * h / 3 * a)
        return q + h * (0.25 * v + 0.75 * (v + 2 * h / 3 * a)), v + h * (0.25 * a + 0.75 * b)

    def divided(accel, t, q, v, h):
        """RK4 with 2 / k2 for 2 k2 in the position: the error falls and rises again."""
        k1, a1 = v, accel(t, q, v)
        k2, a2 = v + h / 2 * a1, accel(t + h / 2, q + h / 2 * k1, v + h / 2 * a1)
        k3, a3 = v + h / 2 * a2, accel(t + h / 2, q + h / 2 * k2, v + h / 2 * a2)
        k4, a4 = v + h * a3, accel(t + h, q + h * k3, v + h * a3)
        return q + h / 6 * (k1 + 2 / k2 + 2 * k3 + k4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)

    problem = kit.Problem(
        "driven pendulum", probes._problem("rk4_step"), list(probes._Q), list(probes._V), 2.0, 1.2, 0.6
    )
    for step, code in ((off_by_a_tenth, "DOES_NOT_CONVERGE"), (ralston, "ORDER_TOO_LOW"), (divided, None)):
        fake = Fake(rk4_step=step)
        measured = kit.march_errors(fake, "rk4_step", problem, [16, 32, 64])
        found = probes.of_order_measured(fake, "rk4_step", *measured, problem.run(16))
        assert (found and found.code) == code
        assert probes.of_step(fake, "rk4_step") is None  # of one step it is not said how errors fall


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_single_precision_is_told_from_a_wrong_formula(task):
    def single(accel, t, q, v, h):
        right = formulas.RIGHT[task][-1](accel, t, q, v, h)
        return [np.asarray(part, np.float32).astype(float) for part in right]

    assert probes.of_step(Fake(**{task: single}), task).code == "FEW_DIGITS"


def test_the_half_of_the_state_that_is_wrong_is_named_where_the_other_is_right():
    right = np.array([1.0, 2.0]), np.array([3.0, 4.0])
    assert probes.of_halves(right[0], 2 * right[1], right).code == "VELOCITY_ALONE_WRONG"
    assert probes.of_halves(2 * right[0], right[1], right).code == "POSITION_ALONE_WRONG"
    assert probes.of_halves(2 * right[0], 2 * right[1], right) is None


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


MIXED = [order for order in itertools.permutations(range(3)) if order != (0, 1, 2)]


@pytest.mark.parametrize("task", formulas.RIGHT)
@pytest.mark.parametrize("order", MIXED, ids=str)
def test_arguments_of_the_acceleration_in_another_order_are_recognised(task, order):
    for right in formulas.RIGHT[task]:

        def step(accel, t, q, v, h, right=right):
            return right(lambda *state: accel(*(state[i] for i in order)), t, q, v, h)

        assert probes.of_step(Fake(**{task: step}), task).code == "ACCEL_ARGUMENTS_MIXED"
        assert probes.of_energy(Fake(**{task: step}), task, 0.1, 0.2).code == "ACCEL_ARGUMENTS_MIXED"


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


COUNTING = {
    "COUNT_NOT_ROUNDED": lambda t_end, h: int(t_end / h),
    "OFF_BY_ONE_SAMPLE": lambda t_end, h: round(t_end / h) - 1,
    None: lambda t_end, h: round(t_end / h) + 3,
}


def test_a_limit_is_too_late_too_early_or_nearly_right():
    sides = {1.9: "SEARCH_TOO_COARSE", 3.0: "LIMIT_TOO_LATE", 1.2: "LIMIT_TOO_EARLY"}
    assert {z: probes._beside(z, 2.0) for z in sides} == sides
    assert probes._beside(1.0, 0.0) == "NO_ZERO"
    assert probes._beside(-1.0, 0.0) is None
    assert probes._beside(0.0, 0.2) == "LIMIT_TOO_EARLY"  # none of it is nearly all of it


def test_a_power_of_the_step_is_told_from_wrong_weights():
    step = formulas._runge_kutta(size=lambda h: h * h)
    assert probes.of_step(Fake(rk4_step=step), "rk4_step").code == "POWER_OF_STEP_WRONG"


def test_one_acceleration_for_all_is_told_from_frozen_times():
    def verlet(accel, t, q, v, h):
        a = np.asarray(accel(t, q, v))
        return q + h * v + h * h / 6 * a, v + h * a

    assert probes.of_step(Fake(velocity_verlet_step=verlet), "velocity_verlet_step") is None


def test_a_time_for_each_coordinate_is_in_its_place():
    def euler(accel, t, q, v, h):
        return q + h * v, v + h * h * np.asarray(accel(t * np.ones_like(q), q, v))

    assert not probes._mixes_arguments(Fake(explicit_euler_step=euler), "explicit_euler_step")


def _loop(told, carries=True):
    """A loop that tells its step the time ``told(i, h)``."""

    def integrate(step, accel, q0, v0, t_end, h):
        n = round(t_end / h)
        q, v = [np.array(q0, dtype=float)], [np.array(v0, dtype=float)]
        for i in range(n):
            q_next, v_next = step(accel, told(i, h), q[-1 if carries else 0], v[-1 if carries else 0], h)
            q.append(q_next)
            v.append(v_next)
        return h * np.arange(n + 1), np.array(q), np.array(v)

    return integrate


@pytest.mark.parametrize(
    ("code", "told", "carries"),
    [
        ("TIME_NOT_PASSED", lambda i, h: 0.0, True),
        ("TIME_AHEAD", lambda i, h: (i + 1) * h, True),
        ("STATE_NOT_CARRIED", lambda i, h: i * h, False),
        (None, lambda i, h: h if i else 0.0, True),
    ],
)
def test_times_are_told_from_states_that_are_not_carried(code, told, carries):
    n, h, clock = 5, 0.2, systems.LinearStep([1.0], [0.0], [0.0], [1.0], clock=2.0)
    fake = Fake(integrate=_loop(told, carries))
    _, q, _ = fake.call("integrate", clock, systems.Oscillator(1.7), [0.5], [0.0], n * h, h)
    found = probes.of_times(fake, np.diff(q[:, 0]) / (2.0 * h), h)
    assert (found and found.code) == code


def test_a_numpy_error_is_no_refusal_of_a_duration():
    def integrate(step, accel, q0, v0, t_end, h):
        raise kit.StudentFailure("error", type="ValueError")

    raising = Fake(integrate=integrate)
    assert probes.of_refusal(raising, np.ones(1), np.ones(1), 0.29) is None
    assert probes.of_whole_start(raising, [None, None, np.array([1]), np.array([1]), 1.0, 0.25]) is None


def test_a_step_that_asks_at_no_time_of_its_own_is_recognised():
    def step(accel, t, q, v, h):
        return q + h * v, v + h * np.asarray(accel(0.0, q, v))

    assert probes.of_step(Fake(explicit_euler_step=step), "explicit_euler_step").code == "TIME_OUTSIDE_STEP"


@pytest.mark.parametrize(("code", "count"), COUNTING.items(), ids=map(str, COUNTING))
def test_the_rule_behind_a_wrong_number_of_samples_is_recognised(code, count):
    def integrate(step, accel, q0, v0, t_end, h):
        n = count(t_end, h)
        return [h * np.arange(n + 1), np.zeros((n + 1, 1)), np.zeros((n + 1, 1))]

    found = probes.of_count(Fake(integrate=integrate), 29, 0.01)
    assert (found and found.code) == code


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
    ("code", "wrong"),
    [
        ("ORDER_SIGN_FLIPPED", lambda x, y: -slope(x, y)),
        ("ORDER_SIGN_FLIPPED", lambda x, y: slope(x, y[::-1])),
        ("ORDER_NEGATIVE", lambda x, y: slope(x, y) - 5),
        ("ORDER_ROUNDED", lambda x, y: float(round(slope(x, y)))),
        ("ORDER_ROUNDED", lambda x, y: float(math.ceil(slope(x, y)))),
        (None, lambda x, y: 2.0),
        (None, lambda x, y: 1.234),
        (None, lambda x, y: math.nan),
    ],
)
def test_a_wrong_slope_shows_what_it_shows(code, wrong):
    fake = Fake(observed_order=lambda hs, errors: float(wrong(np.log(hs), np.log(errors))))
    found = probes.of_order(fake, fake.call("observed_order", HS, ERRORS), HS, ERRORS)
    assert (found and found.code) == code


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


def search(size, dz=0.01, zero=0.0, infinity=math.inf):
    """A max_stable_step that walks up and asks ``size`` of the matrix to stay below one."""

    def max_stable_step(step, omega):
        grid = np.arange(0.05, 10.0, dz)
        fails = np.flatnonzero(size(step.matrix(grid)) > 1 + 1e-8)
        z = infinity if not fails.size else grid[fails[0]] if fails[0] else zero
        return float(z / omega)

    return max_stable_step


RADIUS = lambda m: abs(np.linalg.eigvals(m)).max(axis=-1)  # noqa: E731
SHEARED = systems.LinearStep([1, 0, -0.5], [0, 1], [0, -1, 0, 0.25], [1, 0, -0.5])
EULER = systems.LinearStep([1.0], [0.0, 1.0], [0.0, -1.0], [1.0])
CALM = systems.LinearStep([0.5], [0.1], [0.0], [0.4])


@pytest.mark.parametrize(
    ("code", "function", "step", "limit"),
    [
        ("RETURNS_Z", lambda step, omega: search(RADIUS)(step, 1.0), SHEARED, 2.0),
        ("ASSUMES_ITS_LIMIT", lambda step, omega: 1.7 / omega, SHEARED, 2.0),
        ("NO_ZERO", search(RADIUS, zero=0.05), EULER, 0.0),
        ("NO_INFINITY", search(RADIUS, infinity=10.0), CALM, math.inf),
        ("SEARCH_TOO_COARSE", search(RADIUS, dz=0.5), SHEARED, 2.0),
        ("LIMIT_TOO_EARLY", search(lambda m: abs(m).sum(axis=(-1, -2))), SHEARED, 2.0),
    ],
)
def test_a_wrong_stability_search_is_recognised(code, function, step, limit):
    omega = 3.0
    fake = Fake(max_stable_step=function)
    assert probes.of_stability(fake, function(step, omega), step, omega, limit).code == code


def walked(limit=1 + 1e-8, begin=lambda omega: 0.05 / omega):
    """A max_stable_step in small increments of h; ``limit``: on the spectral radius."""

    def max_stable_step(step, omega):
        h = begin(omega)
        stable = lambda h: RADIUS(step.matrix(h * omega)) <= limit  # noqa: E731
        if not stable(h):
            return 0.0
        while stable(h + 0.002 / omega):
            h += 0.002 / omega
            if h * omega >= 10:
                return math.inf
        return h

    return max_stable_step


@pytest.mark.parametrize(("limit", "right"), [(1 + 1e-8, True), (1 + 1e-6, False), (1 + 1e-5, False)])
def test_slow_growth_tells_a_limit_that_is_too_loose(limit, right):
    step, wanted = cases.slow_growth(2.6), (cases.slow_growth(2.6), 1.3, 2.6)
    fake = Fake(max_stable_step=walked(limit))
    with contextlib.nullcontext() if right else pytest.raises(kit.CheckFailed):
        cases.expect_limit(fake, walked(limit)(step, 1.3), wanted, input={}, message="wrong")


@pytest.mark.parametrize(
    ("program", "codes"),
    [
        (walked(), set()),
        (walked(1 + 1e-6), {"TOLERANCE_TOO_LOOSE"}),
        (walked(1 + 1e-4), {"TOLERANCE_TOO_LOOSE"}),
        (walked(begin=lambda omega: 0.05), {"SEARCH_IN_SECONDS"}),
    ],
)
def test_a_loose_limit_and_a_search_in_seconds_are_known_by_their_answers(program, codes):
    assert known("max_stable_step", program) == codes


@pytest.mark.parametrize(
    ("second", "fourth", "code"),
    [(1.0, 1.0, "HALF_STEP_MISSING"), (0.5, 0.5, "LAST_STAGE_AT_HALF")],
)
def test_one_stage_of_rk4_at_another_point_of_the_step_is_known_by_its_answers(second, fourth, code):
    def rk4_step(accel, t, q, v, h):
        k1q, k1v = v, accel(t, q, v)
        k2q, k2v = v + second * h * k1v, accel(t + second * h, q + second * h * k1q, v + second * h * k1v)
        k3q, k3v = v + h / 2 * k2v, accel(t + h / 2, q + h / 2 * k2q, v + h / 2 * k2v)
        k4q, k4v = v + h * k3v, accel(t + fourth * h, q + fourth * h * k3q, v + fourth * h * k3v)
        return q + h / 6 * (k1q + 2 * k2q + 2 * k3q + k4q), v + h / 6 * (k1v + 2 * k2v + 2 * k3v + k4v)

    assert known("rk4_step", rk4_step) == {code}


def known(task, program):
    """The codes of the known programs that answer all questions as this one does."""
    table = read_table(ROOT / "exercises/integrators")
    said = answer_numbers(
        questions, task, lambda calls: [program(*call) for call in calls], table.within.get(task)
    )
    return {code for row in matching(table, task, said[task]) for code in row.codes}

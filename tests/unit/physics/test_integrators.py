"""The textbook steppers, and values between two samples. The numbers are theory's, not theirs."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.physics import exact, systems
from course.physics.integrators import (
    RK4,
    ExplicitEuler,
    SemiImplicitEuler,
    State,
    VelocityVerlet,
    falling_root,
    first_crossing,
    hermite,
    trajectory,
)
from course.physics.invariants import (
    convergence_order,
    energy,
    jacobian,
    relative_change,
    symplecticity_defect,
)

ALL = [
    ExplicitEuler(),
    SemiImplicitEuler(),
    SemiImplicitEuler(position_first=True),
    VelocityVerlet(),
    VelocityVerlet(drift_first=True),
    RK4(),
]
#: Of the acceleration in a step; of all others one.
EVALUATIONS = {VelocityVerlet(): 2, RK4(): 4}
PROBLEMS = [
    (systems.Oscillator(1.3), [0.8, -0.5], [0.4, 0.9]),
    (systems.Pendulum(9.81, 6.0), [1.1], [-0.4]),
    (systems.ForcedOscillator(1.3, 1.5, 2.1), [0.8], [-0.6]),
    (systems.Kepler(1.0), [0.9, 0.1], [0.1, 1.1]),
]
DISSIPATIVE = [
    (systems.DampedOscillator(1.3, 0.5), [0.8], [0.6]),
    (systems.VanDerPol(0.5, 1.1), [0.8], [0.6]),
]


def measured_order(stepper, system, q0, v0):
    span, t0 = 1.3, 0.4
    first = {1: 128, 2: 32, 4: 16}[stepper.order]
    times = t0 + span * np.array([0.25, 0.5, 0.75, 1.0])
    q_true, v_true = exact.reference(system, q0, v0, times, t0)
    hs, errors = [], []
    for n in (first, 2 * first, 4 * first):
        path = trajectory(stepper, system, State.of(q0, v0, t0), span / n, n)
        rows = slice(n // 4, None, n // 4)
        hs.append(span / n)
        errors.append(max(np.abs(path.q[rows] - q_true).max(), np.abs(path.v[rows] - v_true).max()))
    return convergence_order(hs, errors)


@pytest.mark.parametrize("stepper", ALL, ids=repr)
@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: type(p[0]).__name__)
def test_every_method_has_the_order_it_declares(stepper, problem):
    assert measured_order(stepper, *problem) == pytest.approx(stepper.order, abs=0.12)


@pytest.mark.parametrize("stepper", [ExplicitEuler(), RK4()], ids=repr)
@pytest.mark.parametrize("problem", DISSIPATIVE, ids=lambda p: type(p[0]).__name__)
def test_methods_without_a_splitting_keep_their_order_under_damping(stepper, problem):
    assert measured_order(stepper, *problem) == pytest.approx(stepper.order, abs=0.12)


@pytest.mark.parametrize("stepper", [VelocityVerlet(), VelocityVerlet(drift_first=True)], ids=repr)
def test_verlet_drops_to_first_order_under_damping_as_its_docstring_says(stepper):
    assert measured_order(stepper, *DISSIPATIVE[0]) == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize(("position_first", "worst"), [(False, 0.310), (True, 0.517)])
def test_semi_implicit_eulers_energy_swing_from_a_moving_start_depends_on_its_form(position_first, worst):
    system, h = systems.Oscillator(2.0), 0.25
    path = trajectory(SemiImplicitEuler(position_first), system, State.of([1.0], [0.6]), h, 2000)
    assert np.abs(relative_change(energy(system, path.q, path.v))).max() == pytest.approx(worst, abs=0.001)


@pytest.mark.parametrize("stepper", ALL, ids=repr)
def test_a_method_is_symplectic_exactly_if_its_docstring_says_so(stepper):
    system, h = systems.Kepler(1.0), 0.6

    def flow(y):
        end = stepper.advance(system, State.of(y[:2], y[2:]), h)
        return np.concatenate([end.q, end.v])

    defect = symplecticity_defect(jacobian(flow, [0.9, 0.1, 0.1, 1.1]))
    if "not symplectic" in stepper.__doc__:
        assert defect > 1e-5
    else:
        assert defect < 1e-8


@pytest.mark.parametrize("drift_first", [False, True])
def test_verlet_retraces_its_path_when_turned_round(drift_first):
    system, stepper, h = systems.Pendulum(9.81, 1.0), VelocityVerlet(drift_first), 0.1
    there = trajectory(stepper, system, State.of([1.1], [0.4]), h, 80)
    back = trajectory(stepper, system, State.of(there.q[-1], -there.v[-1]), h, 80)
    assert back.q[-1] == pytest.approx(there.q[0], abs=1e-9)


@pytest.mark.parametrize("stepper", ALL, ids=repr)
def test_a_step_takes_the_number_of_evaluations_that_the_table_says(stepper):
    calls = []

    class Counting:
        def __call__(self, t, q, v):
            calls.append(t)
            return -q

        def params(self):
            return {}

    stepper.advance(Counting(), State.of([1.0], [0.5], t=2.0), 0.1)
    assert len(calls) == EVALUATIONS.get(stepper, 1)


@pytest.mark.parametrize("stepper", ALL, ids=repr)
def test_a_step_leaves_the_old_state_alone_and_shares_no_memory_with_it(stepper):
    state = State.of([1.0, 2.0], [0.5, -0.5])
    end = stepper.advance(systems.Kepler(1.0), state, 0.1)
    assert np.array_equal(state.q, [1.0, 2.0])
    assert np.array_equal(state.v, [0.5, -0.5])
    assert not np.may_share_memory(end.q, state.q)
    assert not np.may_share_memory(end.v, state.v)
    assert end.t == pytest.approx(0.1)


def test_a_trajectory_has_one_sample_more_than_steps_and_times_that_do_not_drift():
    path = trajectory(VelocityVerlet(), systems.Oscillator(2.0), State.at_rest([1.0]), 0.01, 500)
    assert path.t.shape == (501,)
    assert path.t[-1] == 5.0
    assert path.q.shape == path.v.shape == (501, 1)
    assert path.q[0] == 1.0


REST = State.at_rest([1.0])


@pytest.mark.parametrize(
    ("start", "h", "n", "words"),
    [
        *[(REST, h, 3, "A step must be a finite number of seconds") for h in (0.0, math.nan, math.inf)],
        *[(REST, 0.1, n, "whole number, 0 or more") for n in (-1, 2.5, True, math.nan)],
        (State.of([math.nan], [0.0]), 0.1, 3, "The start must be finite"),
        (State.of([0.0], [math.inf]), 0.1, 3, "The start must be finite"),
        (State.of([0.0], [0.0], math.nan), 0.1, 3, "The start must be finite"),
    ],
)
def test_a_trajectory_refuses_a_start_a_step_or_a_count_that_is_none(start, h, n, words):
    with pytest.raises(ValueError, match=words):
        trajectory(RK4(), systems.FreeFall(), start, h, n)


def test_a_trajectory_refuses_a_system_whose_acceleration_is_no_number():
    class Nowhere:
        def __call__(self, t, q, v):
            return np.full(q.shape, math.nan)

    with pytest.raises(ValueError, match="acceleration of Nowhere is not a number"):
        trajectory(ExplicitEuler(), Nowhere(), State.at_rest([1.0]), 0.1, 3)


def test_a_trajectory_runs_backwards_and_takes_no_step_where_none_is_asked():
    there = trajectory(RK4(), systems.FreeFall(), State.of([1.0], [2.0]), 0.1, 10)
    back = trajectory(RK4(), systems.FreeFall(), State(1.0, there.q[-1], there.v[-1]), -0.1, 10)
    assert back.q[-1] == pytest.approx(there.q[0])
    assert trajectory(RK4(), systems.FreeFall(), State.at_rest([1.0]), 0.1, 0).q.shape == (1, 1)


numbers = st.floats(-10, 10)


@given(numbers, numbers, numbers, numbers, st.floats(0, 1))
def test_a_cubic_is_interpolated_exactly(a, b, c, d, s):
    def value(x):
        return a + x * (b + x * (c + x * d))

    slopes = b, b + 2 * c + 3 * d
    ends = np.float64(value(0.0)), np.float64(value(1.0))
    assert hermite(s, *ends, *map(np.float64, slopes)) == pytest.approx(value(s), abs=1e-12)


@given(st.floats(0.01, 10), st.floats(-10, 10), st.floats(0.1, 50))
def test_a_fall_lands_when_the_closed_form_says(height, rate, g):
    due = (rate + math.sqrt(rate**2 + 2 * g * height)) / g
    span = 1.3 * due
    end, end_rate = height + rate * span - g * span**2 / 2, rate - g * span
    share = falling_root(*map(np.float64, (height, end, rate * span, end_rate * span)))
    assert share * span == pytest.approx(due, rel=1e-9)


def test_a_curve_that_does_not_end_below_zero_has_no_root():
    assert falling_root(*map(np.float64, (1.0, 0.5, -1.0, -1.0))) == np.inf


def test_starting_at_zero_and_rising_finds_the_way_down_and_falling_finds_the_start():
    # 2 s - 4 s² from 0: comes down at 1/2.
    assert falling_root(*map(np.float64, (0.0, -2.0, 2.0, -6.0))) == pytest.approx(0.5)
    assert falling_root(*map(np.float64, (-1e-12, -2.0, -2.0, -2.0))) == 0.0


def test_the_first_of_several_crossings_is_found_far_between_samples():
    t = np.linspace(0.0, 10.0, 101)
    assert first_crossing(t, np.cos(t), -np.sin(t)) == pytest.approx(math.pi / 2, abs=1e-7)
    assert math.isnan(first_crossing(t, np.ones_like(t), np.zeros_like(t)))

"""The textbook steppers, values between two samples, and what both are measured against and with.

The numbers are theory's, not theirs.
"""

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
    angular_momentum,
    convergence_order,
    energy,
    jacobian,
    relative_change,
    spectral_radius,
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
DAMPED = [
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


@pytest.mark.parametrize(
    ("stepper", "problem", "order"),
    [
        *[(stepper, problem, stepper.order) for stepper in ALL for problem in PROBLEMS],
        # Without a splitting, methods keep their order under damping; Verlet drops, as its docstring says.
        *[(stepper, problem, stepper.order) for stepper in (ExplicitEuler(), RK4()) for problem in DAMPED],
        *[(VelocityVerlet(drift_first), DAMPED[0], 1) for drift_first in (False, True)],
    ],
    ids=lambda one: type(one[0]).__name__ if isinstance(one, tuple) else repr(one),
)
def test_every_method_has_the_order_it_declares(stepper, problem, order):
    assert measured_order(stepper, *problem) == pytest.approx(order, abs=0.12)


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


# -- the reference ---------------------------------------------------------------------------------------

TIMES = [0.6, 1.1, 2.9, 5.0]
Q0, V0 = [0.8, -0.3], [-0.4, 1.1]


def test_the_reference_brings_an_eccentric_orbit_back_after_one_period():
    e = 0.6
    q0, v0 = [1 - e, 0.0], [0.0, math.sqrt((1 + e) / (1 - e))]
    q, v = exact.reference(systems.Kepler(1.0), q0, v0, [2 * math.pi])
    assert q[0] == pytest.approx(q0, abs=1e-10)
    assert v[0] == pytest.approx(v0, abs=1e-10)


@pytest.mark.parametrize(
    "system",
    [
        systems.Oscillator(2.3),
        systems.DampedOscillator(2.3, 0.7),
        systems.DampedOscillator(0.3, 0.7),
        systems.ForcedOscillator(2.3, 1.5, 3.1),
        systems.ForcedOscillator(2.3, 1.5, 2.3),
        systems.Pendulum(9.81, 1.2),
    ],
    ids=repr,
)
def test_the_solution_is_the_reference_with_and_without_a_closed_form(system):
    for found, expected in zip(
        exact.solution(system, Q0, V0, TIMES, 0.2), exact.reference(system, Q0, V0, TIMES, 0.2), strict=True
    ):
        assert found.shape == (4, 2)
        assert found == pytest.approx(expected, abs=1e-10)


def test_times_that_run_backwards_are_refused():
    with pytest.raises(ValueError, match="rise"):
        exact.reference(systems.Oscillator(1.0), [1.0], [0.0], [1.0, 0.5])


def test_a_solution_that_blows_up_is_refused_instead_of_returned():
    class Explosion:
        def __call__(self, t, q, v):
            return np.exp(np.minimum(q, 300.0))

        def params(self):
            return {}

    with np.errstate(all="ignore"), pytest.raises(ValueError, match="converge"):
        exact.reference(Explosion(), [1.0], [5.0], [3.0])


def test_closed_forms_refuse_parameters_they_do_not_cover():
    with pytest.raises(ValueError, match="omega"):
        exact.damped_oscillator(systems.DampedOscillator(1.0, 2.0), Q0, V0, 1.0)
    with pytest.raises(ValueError, match="resonance"):
        exact.forced_oscillator(systems.ForcedOscillator(2.0, 1.0, 2.0), Q0, V0, 1.0)


# -- instruments -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("system", "q0", "v0"),
    [
        (systems.FreeFall(9.81), [0.0, 10.0], [3.0, 1.0]),
        (systems.Oscillator(2.0), [1.0, 0.2], [0.0, -1.0]),
        (systems.Pendulum(9.81, 1.3), [1.2], [0.5]),
        (systems.Kepler(1.0), [0.8, 0.1], [0.2, 1.1]),
    ],
    ids=lambda value: type(value).__name__,
)
def test_the_energy_of_the_true_motion_is_constant(system, q0, v0):
    q, v = exact.reference(system, q0, v0, np.linspace(0.0, 3.0, 7))
    assert energy(system, q, v) == pytest.approx(float(energy(system, q0, v0)), rel=1e-11)


def test_a_driven_or_damped_system_has_no_energy_to_conserve():
    with pytest.raises(TypeError, match="DampedOscillator"):
        energy(systems.DampedOscillator(1.0, 0.1), [1.0], [0.0])


def test_the_angular_momentum_of_an_orbit_is_constant():
    q, v = exact.reference(systems.Kepler(1.3), [0.8, 0.1], [0.2, 1.1], np.linspace(0.0, 3.0, 7))
    assert angular_momentum(q, v) == pytest.approx(0.8 * 1.1 - 0.1 * 0.2, rel=1e-11)


def test_relative_change_is_signed_and_starts_at_zero():
    assert relative_change([-2.0, -1.0, -3.0]) == pytest.approx([0.0, 0.5, -0.5])


def test_the_order_of_scattered_points_is_the_least_squares_slope():
    hs, errors = [0.1, 0.05, 0.025, 0.01], [0.9, 0.3, 0.2, 0.04]
    assert convergence_order(hs, errors) == pytest.approx(np.polyfit(np.log(hs), np.log(errors), 1)[0])


@pytest.mark.parametrize(("hs", "errors"), [([0.1], [1.0]), ([0.1, 0.2], [1.0]), ([0.1, 0.2], [1.0, 0.0])])
def test_points_that_have_no_slope_are_refused(hs, errors):
    with pytest.raises(ValueError):
        convergence_order(hs, errors)


def test_the_jacobian_of_a_smooth_map_is_found_to_ten_digits():
    found = jacobian(lambda y: np.array([math.sin(y[0]) * y[1], y[0] ** 3]), [0.7, 2.0])
    assert found == pytest.approx(np.array([[2 * math.cos(0.7), math.sin(0.7)], [3 * 0.49, 0.0]]), abs=1e-9)


def test_preserving_volume_is_not_enough_to_be_symplectic_in_two_degrees_of_freedom():
    stretch = np.diag([2.0, 0.5, 1.0, 1.0])  # determinant one, yet q1 and its own velocity do not match
    assert np.linalg.det(stretch) == pytest.approx(1.0)
    assert symplecticity_defect(stretch) == pytest.approx(1.0)
    assert symplecticity_defect(np.diag([2.0, 3.0, 0.5, 1 / 3.0])) == pytest.approx(0.0, abs=1e-15)


def test_the_spectral_radius_takes_the_modulus_of_negative_and_complex_eigenvalues():
    assert spectral_radius([[0.2, 5.0], [0.0, -1.4]]) == pytest.approx(1.4)
    assert spectral_radius([[0.0, 2.0], [-2.0, 0.0]]) == pytest.approx(2.0)

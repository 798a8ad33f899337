"""The arm: forward and inverse undo each other, energy and geometry hold, paths are straight and smooth."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course.physics.dynamics import HandPath, PassiveArm, TwoLinkArm, smooth_share
from course.physics.integrators import RK4, State, trajectory
from course.physics.invariants import convergence_order, jacobian

pairs = st.lists(st.floats(-6, 6), min_size=2, max_size=2).map(np.array)
sizes = st.floats(0.2, 3)
arms = st.builds(TwoLinkArm, sizes, sizes, sizes, sizes, st.floats(0.05, 2), st.floats(0.05, 2), sizes, sizes)


@given(arms, pairs, pairs, pairs)
def test_inverse_dynamics_undoes_forward_dynamics(arm, q, v, torque):
    back = arm.inverse(q, v, arm.forward(q, v, torque))
    scale = 1.0 + np.max(np.abs(arm.bias(q, v))) + np.max(np.abs(torque))
    np.testing.assert_allclose(back, torque, atol=1e-10 * scale)


@given(arms, pairs)
def test_the_mass_matrix_is_symmetric_and_positive(arm, q):
    m = arm.mass_matrix(q)
    assert m[0, 1] == m[1, 0]
    assert np.all(np.linalg.eigvalsh(m) > 0)


@given(arms, pairs)
def test_holding_torques_are_the_slope_of_the_potential_energy(arm, q):
    slope = jacobian(lambda y: np.atleast_1d(arm.energy(y, np.zeros(2))), q)[0]
    np.testing.assert_allclose(arm.bias(q, np.zeros(2)), slope, atol=1e-6 * (1 + np.abs(slope).max()))


@given(pairs)
def test_the_jacobian_is_the_slope_of_the_hand(q):
    arm = TwoLinkArm(length1=0.7, length2=1.3)
    np.testing.assert_allclose(arm.jacobian(q), jacobian(arm.hand, q), atol=1e-8)


@given(st.floats(0.65, 1.95), st.floats(-math.pi, math.pi), st.booleans())
def test_reaching_puts_the_hand_there(distance, angle, up):
    arm = TwoLinkArm(length1=0.7, length2=1.3)
    place = distance * np.array([math.cos(angle), math.sin(angle)])
    np.testing.assert_allclose(arm.hand(arm.reach(place, elbow_up=up)), place, atol=1e-9)


def test_a_place_out_of_reach_is_refused_with_the_reach():
    with pytest.raises(ValueError, match=r"0\.6 m to 2 m"):
        TwoLinkArm(length1=0.7, length2=1.3).reach([0.0, 2.1])


def test_a_double_pendulum_keeps_its_energy_to_the_order_of_the_method():
    pendulum = TwoLinkArm.double_pendulum()
    drifts = []
    for h in (0.01, 0.005):
        run = trajectory(RK4(), PassiveArm(pendulum), State.at_rest([0.5, 1.0]), h, round(3 / h))
        energy = pendulum.energy(run.q, run.v)
        drifts.append(float(np.max(np.abs(energy - energy[0]))))
    assert convergence_order([0.01, 0.005], drifts) > 3.5
    assert drifts[1] < 1e-4


def test_a_small_swing_of_a_double_pendulum_has_the_two_frequencies_of_the_closed_form():
    pendulum = TwoLinkArm.double_pendulum()
    stiffness = jacobian(lambda q: pendulum.bias(q, np.zeros(2)), [-math.pi / 2, 0.0])
    squares = np.linalg.eigvals(np.linalg.solve(pendulum.mass_matrix([-math.pi / 2, 0.0]), stiffness))
    # w² = (2 ± sqrt 2) g / l
    np.testing.assert_allclose(sorted(squares.real), 9.81 * np.array([2 - 2**0.5, 2 + 2**0.5]), rtol=1e-6)


def test_many_arms_move_at_once_as_they_do_alone():
    arm, starts = TwoLinkArm(), np.random.default_rng(1).normal(size=(9, 2))
    many = trajectory(RK4(), PassiveArm(arm), State.at_rest(starts), 0.01, 50)
    alone = trajectory(RK4(), PassiveArm(arm), State.at_rest(starts[4]), 0.01, 50)
    assert many.q.shape == (51, 9, 2)
    np.testing.assert_allclose(many.q[:, 4], alone.q, atol=1e-12)


@given(st.floats(0.2, 5))
@settings(max_examples=20)
def test_joint_rates_and_accelerations_of_a_path_are_its_derivatives(duration):
    arm, path = TwoLinkArm(), HandPath((1.2, -0.8), (0.6, 1.2), duration)
    t = duration * np.linspace(0.1, 0.9, 9)
    _, v, a = path.joints(arm, t)
    delta = 1e-5 * duration
    later, sooner = path.joints(arm, t + delta), path.joints(arm, t - delta)
    np.testing.assert_allclose((later[0] - sooner[0]) / (2 * delta), v, atol=1e-6 / duration)
    np.testing.assert_allclose((later[1] - sooner[1]) / (2 * delta), a, atol=1e-5 / duration**2)


def test_a_path_is_straight_and_begins_and_ends_at_rest():
    arm, path = TwoLinkArm(), HandPath((1.2, -0.8), (0.6, 1.2), 2.0)
    q, v, a = path.joints(arm, np.linspace(0, 2, 101))
    hand = arm.hand(q) - path.start
    np.testing.assert_allclose(hand[:, 0] * 2.0 + hand[:, 1] * 0.6, 0.0, atol=1e-14)
    np.testing.assert_allclose(arm.hand(q[[0, -1]]), [path.start, path.end], atol=1e-14)
    np.testing.assert_allclose(v[[0, -1]], 0.0, atol=1e-14)
    np.testing.assert_allclose(a[[0, -1]], 0.0, atol=1e-13)


def test_the_smooth_share_runs_from_nothing_to_all_without_turning_back():
    share, rate, _ = smooth_share(np.linspace(-0.5, 1.5, 201))
    assert share[0] == 0.0
    assert share[-1] == 1.0
    assert np.all(np.diff(share) >= 0)
    assert rate.max() == pytest.approx(1.875)


def test_a_path_through_the_shoulder_or_to_a_straight_arm_is_refused():
    with pytest.raises(ValueError, match="straight or folded"):
        HandPath((1.0, 0.0), (2.0, 0.0), 1.0).joints(TwoLinkArm(), np.linspace(0, 1, 11))


def test_an_arm_without_mass_is_refused():
    with pytest.raises(ValueError, match="mass2 must be a positive number"):
        TwoLinkArm(mass2=0.0)

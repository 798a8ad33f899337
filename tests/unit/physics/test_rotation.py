"""Quaternions stay unit, split rotations keep what physics keeps, and explicit Euler does not."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course.physics.invariants import convergence_order
from course.physics.rotation import (
    ROTATION_STEPPERS,
    Spin,
    SplitRotation,
    angular_momentum,
    cross,
    product,
    quaternion,
    rotate,
    turn,
    turn_back,
)

vectors = st.lists(st.floats(-5, 5), min_size=3, max_size=3).map(np.array)
BODY = np.array([1.0, 2.0, 3.0])
START = Spin(np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.01, 5.0, 0.01]))


def march(method, spin, h, n, inertia=BODY):
    q, w = rotate(ROTATION_STEPPERS[method], inertia, spin, h, n)
    return Spin(q[-1], w[-1])


@given(vectors, vectors)
def test_cross_is_numpys(a, b):
    np.testing.assert_allclose(cross(a, b), np.cross(a, b), atol=1e-12)


@given(vectors, vectors)
def test_turning_keeps_lengths_and_turning_back_undoes_it(rotation, vector):
    q = quaternion(rotation)
    turned = turn(q, vector)
    assert np.linalg.norm(turned) == pytest.approx(np.linalg.norm(vector), abs=1e-12)
    np.testing.assert_allclose(turn_back(q, turned), vector, atol=1e-12)


@given(vectors, vectors, vectors)
def test_a_product_turns_by_the_second_then_the_first(p, q, v):
    p, q = quaternion(p), quaternion(q)
    np.testing.assert_allclose(turn(product(p, q), v), turn(p, turn(q, v)), atol=1e-10)


def test_a_quarter_turn_about_z_takes_x_to_y():
    turned = turn(quaternion([0.0, 0.0, math.pi / 2]), np.array([1.0, 0.0, 0.0]))
    np.testing.assert_allclose(turned, [0.0, 1.0, 0.0], atol=1e-15)


def test_no_rotation_is_the_identity():
    assert quaternion(np.zeros((4, 3))).tolist() == [[1.0, 0.0, 0.0, 0.0]] * 4


@given(vectors)
@settings(max_examples=30)
def test_split_rotations_keep_a_unit_quaternion_and_the_angular_momentum(w):
    before = angular_momentum(BODY, START.orientation, w)
    after = march("split", Spin(START.orientation, w), 0.02, 100)
    assert np.linalg.norm(after.orientation) == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(
        angular_momentum(BODY, *after), before, atol=1e-12 * (1 + np.linalg.norm(before))
    )


def test_split_rotations_run_backwards_to_where_they_came_from():
    there = march("split", START, 0.05, 50)
    back = march("split", Spin(there.orientation, -there.angular_velocity), 0.05, 50)
    np.testing.assert_allclose(back.orientation, START.orientation, atol=1e-12)
    np.testing.assert_allclose(-back.angular_velocity, START.angular_velocity, atol=1e-12)


def test_a_spin_about_a_principal_axis_is_solved_exactly():
    after = march("split", Spin(START.orientation, np.array([0.0, 0.0, 2.0])), 0.1, 10)
    np.testing.assert_allclose(after.orientation, quaternion([0.0, 0.0, 2.0]), atol=1e-14)


def test_an_axisymmetric_body_precesses_at_the_rate_of_the_closed_form():
    inertia = np.array([1.0, 1.0, 2.0])
    w3, wobble, t = 3.0, 0.5, 2.0
    # w1 + i w2 turns at (I3 - I1)/I1 w3 in the body's axes.
    rate = (2.0 - 1.0) / 1.0 * w3
    for method, tolerance in (("split", 1e-3), ("rk4", 1e-8)):
        after = march(method, Spin(START.orientation, np.array([wobble, 0.0, w3])), 0.01, 200, inertia)
        exact = [wobble * math.cos(rate * t), wobble * math.sin(rate * t), w3]
        np.testing.assert_allclose(after.angular_velocity, exact, atol=tolerance)


def test_split_rotations_have_order_two_and_runge_kutta_order_four():
    start = Spin(START.orientation, np.array([1.0, 2.0, 0.5]))
    truth = march("rk4", start, 1e-3, 1000)
    for method, order in (("split", 2), ("rk4", 4), ("explicit_euler", 1)):
        hs = [0.02, 0.01, 0.005]
        errors = [
            np.linalg.norm(np.concatenate(march(method, start, h, round(1 / h))) - np.concatenate(truth))
            for h in hs
        ]
        assert convergence_order(hs, errors) == pytest.approx(order, abs=0.15)


def test_a_torque_about_an_axis_spins_a_body_up_as_newton_says():
    spin = Spin(START.orientation, np.zeros(3))
    for _ in range(100):
        spin = SplitRotation().advance(BODY, spin, np.array([0.0, 4.0, 0.0]), 0.01)
    np.testing.assert_allclose(spin.angular_velocity, [0.0, 2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(spin.orientation, quaternion([0.0, 1.0, 0.0]), atol=1e-12)


def test_many_bodies_turn_at_once_as_they_do_alone():
    rates = np.random.default_rng(0).normal(size=(7, 3))
    many = march("split", Spin(np.tile(START.orientation, (7, 1)), rates), 0.05, 20)
    alone = [march("split", Spin(START.orientation, w), 0.05, 20) for w in rates]
    np.testing.assert_allclose(many.orientation, [spin.orientation for spin in alone], atol=1e-13)

"""Solvers that go over constraints one by one: what they reach, how fast, and what small steps buy."""

import numpy as np
import pytest

from course.physics.solver import Chain, iterations_to, stack_impulses


def test_a_stack_settles_so_that_each_contact_carries_what_is_above_and_never_pulls():
    impulses = stack_impulses(4, 500)
    np.testing.assert_allclose(impulses[-1], [4.0, 3.0, 2.0, 1.0], atol=1e-9)
    assert np.all(impulses >= 0.0)


def test_an_accuracy_that_is_not_reached_is_said():
    with pytest.raises(ValueError, match="do not settle"):
        iterations_to(20, 0.01, limit=100)


def test_no_boxes_are_no_stack():
    with pytest.raises(ValueError, match="a box or more"):
        stack_impulses(0, 1)


def test_a_chain_with_work_enough_swings_like_a_pendulum():
    # One link is a pendulum: let go level, it passes the lowest point after K(sin 45°) sqrt(l/g).
    chain = Chain(links=1, length=1.0)
    assert chain.stretch(1.0, 0.001, 1, 1).max() < 1e-12


def test_a_frame_that_does_not_divide_is_refused():
    with pytest.raises(ValueError, match="does not divide"):
        Chain().stretch(1.0, 0.3, 1, 1)

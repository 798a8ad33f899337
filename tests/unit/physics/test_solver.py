"""Solvers that go over constraints one by one: what they reach, how fast, and what small steps buy."""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.physics.solver import Chain, iterations_to, stack_impulses


def test_a_stack_settles_so_that_each_contact_carries_what_is_above() -> None:
    np.testing.assert_allclose(stack_impulses(4, 500)[-1], [4.0, 3.0, 2.0, 1.0], atol=1e-9)


def test_impulses_never_pull() -> None:
    assert np.all(stack_impulses(10, 100) >= 0.0)


@pytest.mark.parametrize(("boxes", "needed"), [(2, 7), (5, 45), (10, 178), (20, 713)])
def test_iterations_to_one_per_cent_grow_with_the_square_of_the_height(boxes: int, needed: int) -> None:
    assert iterations_to(boxes) == needed


@pytest.mark.parametrize("boxes", [3, 8, 15])
def test_the_error_shrinks_by_the_factor_that_theory_gives(boxes: int) -> None:
    errors = boxes - stack_impulses(boxes, 3 * boxes**2)[:, 0]
    assert errors[-1] / errors[-2] == pytest.approx(math.cos(math.pi / (2 * boxes)) ** 2, rel=1e-3)


def test_an_accuracy_that_is_not_reached_is_said() -> None:
    with pytest.raises(ValueError, match="do not settle"):
        iterations_to(20, 0.01, limit=100)


def test_no_boxes_are_no_stack() -> None:
    with pytest.raises(ValueError, match="a box or more"):
        stack_impulses(0, 1)


@pytest.mark.parametrize(("substeps", "iterations", "stretch"), [(1, 16, 0.084), (16, 1, 0.015)])
def test_small_steps_beat_iterations_on_a_chain(substeps: int, iterations: int, stretch: float) -> None:
    assert Chain().stretch(2.0, 1 / 60, substeps, iterations).max() == pytest.approx(stretch, abs=5e-4)


def test_a_chain_with_work_enough_swings_like_a_pendulum() -> None:
    # One link is a pendulum: let go level, it passes the lowest point after K(sin 45°) sqrt(l/g).
    chain = Chain(links=1, length=1.0)
    assert chain.stretch(1.0, 0.001, 1, 1).max() < 1e-12


def test_a_frame_that_does_not_divide_is_refused() -> None:
    with pytest.raises(ValueError, match="does not divide"):
        Chain().stretch(1.0, 0.3, 1, 1)

"""What the figures on the engine, contact, dynamics and accuracy show is what their titles say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.figures import contact, robots, sim_to_real
from course.figures.robots import FALLEN, STANDING
from course.physics.rotation import kinetic_energy


def test_a_robot_without_delay_stands_only_where_its_reaction_outweighs_gravity() -> None:
    weight = 50.0 * 9.81 * 0.9  # N m per radian of lean
    kp, kd = np.array([0.5 * weight, 2.0 * weight]), np.array([100.0, 300.0])
    assert robots.fate(kp, kd, 0.0).tolist() == [FALLEN, STANDING]


def test_a_free_body_turns_over_four_times_and_only_explicit_euler_gains_energy() -> None:
    def gain(method: str) -> float:
        _, spins, _ = contact.free_spin(method)
        ends = kinetic_energy(contact.INERTIA, spins[[0, -1]])
        return float(ends[1] / ends[0] - 1)

    _, spins, lengths = contact.free_spin("split")
    assert np.count_nonzero(np.diff(np.sign(spins[:, 1]))) == 4
    assert lengths == pytest.approx(1.0, abs=1e-12)
    assert gain("explicit_euler") == pytest.approx(0.278, abs=5e-4)
    assert abs(gain("rk4")) < 1e-8
    assert abs(gain("split")) < 1e-8


@pytest.mark.parametrize(("restitution", "end"), [(None, 5.0), (1.0, -6.0), (0.5, -3.25), (0.0, -0.5)])
def test_the_pair_passes_or_parts_as_its_restitution_says(restitution: float | None, end: float) -> None:
    _, x = contact.head_on(restitution)
    assert x[-1].tolist() == pytest.approx([end, -end], abs=1e-9)


def test_a_wall_is_missed_from_the_speed_on_at_which_a_step_spans_wall_and_ball() -> None:
    assert contact.passed(3.9) == 0.0
    assert contact.passed(4.1) > 0.0
    assert contact.passed(20.0) == pytest.approx(0.8)
    assert contact.passed(20.0, contact.STEP_S / 2) == pytest.approx(0.6)


def test_planned_torques_carry_the_bare_arm_and_feedback_carries_a_forgotten_load() -> None:
    def miss(load: float, *, feedback: bool = False) -> float:
        hand = robots.driven(load, feedback=feedback)
        return math.dist(hand[-1], robots.END)

    assert miss(0.0) < 1e-5
    assert miss(0.01) > 0.3
    assert miss(0.1) > 2.0
    assert miss(0.1, feedback=True) < 0.005


def test_single_precision_has_a_best_step_and_double_precision_does_not_yet() -> None:
    steps = 2.0 ** -np.arange(8, 18)
    single = [sim_to_real._typical_error(float(h), np.float32) for h in steps]
    double = [sim_to_real._typical_error(float(h), np.float64) for h in steps]
    assert 0 < int(np.argmin(single)) < len(steps) - 1
    assert steps[int(np.argmin(single))] == pytest.approx(1e-4, rel=0.25)
    assert np.all(np.diff(double) < 0)


def test_every_halving_of_the_substep_stretches_the_chain_less_for_the_same_work() -> None:
    rows = sim_to_real.splits()
    assert all(substeps * iterations == 16 for substeps, iterations, _ in rows)
    stretches = [stretch for _, _, stretch in rows]
    assert stretches == sorted(stretches, reverse=True)
    assert (stretches[0], stretches[-1]) == pytest.approx((0.0836, 0.0149), abs=1e-4)


def test_two_crowds_with_different_steps_point_alike_though_their_paths_part() -> None:
    coarse, fine = (np.array(sim_to_real._crowd(h)) for h in (0.02, 0.01))
    assert coarse.sum() == pytest.approx(100.0)
    assert np.max(np.abs(coarse - fine)) < 0.5  # of about 5.6 in each direction
    assert np.ptp(fine) > 1.5  # and the habit is one: more often down than up
    start = np.radians([160.0, -95.0])
    ends = [sim_to_real.swing(start, h, 12.0)[1][-1, 1] for h in (0.02, 0.01)]
    assert abs(ends[0] - ends[1]) > 0.5

"""What the figures of engines, twins, the gap and the summary show is what their titles say."""

from __future__ import annotations

import numpy as np
import pytest

from course.engines import reference
from course.figures import contact, engines, robots, sim_to_real
from course.figures.style import house_style
from course.physics.contact.models import Constraint
from course.physics.dynamics import TwoLinkArm


def test_every_error_is_drawn_inside_its_panel() -> None:
    with house_style():
        figure = engines.settings()
    for axes in figure.axes:
        low, high = axes.get_xlim()
        drawn = [float(x) for line in axes.lines for x in np.atleast_1d(line.get_xdata())]
        assert all(low <= x <= high for x in drawn)


def test_an_error_of_the_reference_is_its_value_against_the_truth() -> None:
    row = reference.row("mujoco", "bounce", "default")
    assert row.value == 0.0
    assert engines.error("mujoco", "bounce", "default").mean == pytest.approx(100.0)
    swing = reference.row("dart", "double-pendulum", "tuned")
    assert engines.error("dart", "double-pendulum", "tuned").worst == pytest.approx(swing.highest)


def test_a_bounce_depends_on_its_phase() -> None:
    plain = contact.rebounds(Constraint(0.5))
    assert 0.22 < plain.min() < 0.225
    assert 0.25 < plain.max() < 0.26
    assert contact.rebounds(Constraint(0.5, erp=0.2)).max() > 0.45


def test_the_twin_brings_the_robot_back_to_its_speed() -> None:
    speeds = sim_to_real.driven()
    assert speeds["fixed"][-1] == pytest.approx(0.5 / 0.8, rel=1e-3)
    assert speeds["twin"][-200:].mean() == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("seed", range(5))
def test_the_learning_copy_finds_the_friction_whatever_the_noise(seed: int) -> None:
    assert sim_to_real.followed(seed=seed)["friction"][-1] == pytest.approx(0.8, rel=0.05)


def test_a_late_integrator_is_unstable_beyond_half_pi_over_its_delay() -> None:
    delay = 0.1
    limit = np.pi / 2 / delay
    below, above = sim_to_real.settles([0.75 * limit, 1.1 * limit], delay, 1.0)[:, 0]
    assert below < 3.0
    assert above == pytest.approx(3.0)


def test_the_wall_feels_the_mass_that_a_newton_at_the_hand_accelerates() -> None:
    arm = TwoLinkArm()
    for degrees in (1.0, 10.0, 90.0, 150.0):
        bend = np.radians(degrees)
        q = np.array([-bend / 2, bend])
        pushed = arm.jacobian(q).T @ np.array([1.0, 0.0])
        gained = arm.forward(q, np.zeros(2), pushed) - arm.forward(q, np.zeros(2), np.zeros(2))
        assert float(robots.felt(bend)) == pytest.approx(1.0 / (arm.jacobian(q) @ gained)[0], rel=1e-6)
    assert float(robots.felt(np.radians(1.0))) > 900.0
    assert float(robots.felt(np.radians(30.0))) < 2.0


def test_the_shadows_of_the_two_boxes_are_apart_and_their_upright_outlines_are_not() -> None:
    with house_style():
        left = contact.corners().axes[0]
    ends = [np.column_stack(line.get_data()) @ np.array([1.0, 1.0]) / np.sqrt(2.0) for line in left.lines]
    assert len(ends) == 2
    assert ends[1].min() - ends[0].max() == pytest.approx(1.05 * np.sqrt(2.0) - 0.5 - 0.5 * np.sqrt(2.0))
    shape, upright, other, upright_too = (patch.get_xy() for patch in left.patches)
    assert shape.max(axis=0) == pytest.approx(upright.max(axis=0))
    assert other.min(axis=0) == pytest.approx(upright_too.min(axis=0))
    assert (upright_too.min(axis=0) < upright.max(axis=0)).all()

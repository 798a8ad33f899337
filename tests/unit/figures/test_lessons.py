"""What the figures of the lessons show is what their titles and the lessons say."""

import math

import numpy as np
import pytest

from course.engines import reference
from course.figures import contact, engines, integrators, robots, sim_to_real
from course.figures.robots import FALLEN, STANDING
from course.figures.style import METHODS, house_style
from course.physics.dynamics import TwoLinkArm
from course.physics.rotation import kinetic_energy
from course.simulations.experiments.dynamics import from_hanging, swing


@pytest.mark.parametrize(
    ("method", "limit"),
    [("semi_implicit_euler", 2.0), ("velocity_verlet", 2.0), ("rk4", 2.0 * math.sqrt(2.0))],
)
def test_growth_passes_one_at_the_stability_limit(method, limit):
    # The maps have a double eigenvalue at the limit, where round-off shows as its square root.
    assert integrators._growth(method, limit - 0.01) <= 1.0 + 1e-7
    assert integrators._growth(method, limit + 0.01) > 1.0 + 1e-3


def test_explicit_euler_grows_at_every_step():
    assert integrators._growth("explicit_euler", 0.01) > 1.0 + 1e-5


def test_every_curve_of_the_energy_figure_rises_and_runge_kutta_crosses_verlet_where_marked():
    (axes,) = integrators.energy_error().axes
    curves = {line.get_color(): line for line in axes.lines if len(line.get_xdata()) > 1}
    assert all(np.all(np.diff(line.get_ydata()) >= 0) for line in curves.values())
    verlet = np.asarray(curves[METHODS["velocity_verlet"].color].get_ydata())
    rk4 = np.asarray(curves[METHODS["rk4"].color].get_ydata())
    crossing = int(np.argmax(rk4 > verlet)) + 1
    # 18/z^4 is the leading term; at z = 0.5 the next ones are worth a few per cent.
    assert crossing == pytest.approx(18.0 / integrators.ENERGY_Z**4, rel=0.1)


def test_a_robot_without_delay_stands_only_where_its_reaction_outweighs_gravity():
    weight = 50.0 * 9.81 * 0.9  # N m per radian of lean
    kp, kd = np.array([0.5 * weight, 2.0 * weight]), np.array([100.0, 300.0])
    assert robots.fate(kp, kd, 0.0).tolist() == [FALLEN, STANDING]


def test_a_free_body_turns_over_four_times_and_only_explicit_euler_gains_energy():
    def gain(method):
        _, spins, _ = contact.free_spin(method)
        ends = kinetic_energy(contact.INERTIA, spins[[0, -1]])
        return float(ends[1] / ends[0] - 1)

    _, spins, lengths = contact.free_spin("split")
    assert np.count_nonzero(np.diff(np.sign(spins[:, 1]))) == 4
    assert lengths == pytest.approx(1.0, abs=1e-12)
    assert gain("explicit_euler") == pytest.approx(0.278, abs=5e-4)
    assert abs(gain("rk4")) < 1e-8
    assert abs(gain("split")) < 1e-8


@pytest.mark.parametrize(("restitution", "end"), [(1.0, -6.0), (0.5, -3.25), (0.0, -0.5)])
def test_the_pair_passes_or_parts_as_its_restitution_says(restitution, end):
    _, x = contact.head_on(restitution)
    assert x[-1].tolist() == pytest.approx([end, -end], abs=1e-9)


def test_a_wall_is_missed_from_the_speed_on_at_which_a_step_spans_wall_and_ball():
    assert contact.passed(3.9) == 0.0
    assert contact.passed(4.1) > 0.0
    assert contact.passed(20.0) == pytest.approx(0.8)
    assert contact.passed(20.0, contact.STEP_S / 2) == pytest.approx(0.6)


def test_planned_torques_carry_the_bare_arm_and_feedback_carries_a_forgotten_load():
    def miss(load, *, feedback=False):
        hand = robots.driven(load, feedback=feedback)
        return math.dist(hand[-1], robots.END)

    assert miss(0.0) < 1e-5
    assert miss(0.01) > 0.3
    assert miss(0.1) > 2.0
    assert miss(0.1, feedback=True) < 0.005


def test_single_precision_has_a_best_step_and_double_precision_does_not_yet():
    steps = 2.0 ** -np.arange(8, 18)
    single = [sim_to_real._typical_error(float(h), np.float32) for h in steps]
    double = [sim_to_real._typical_error(float(h), np.float64) for h in steps]
    assert 0 < int(np.argmin(single)) < len(steps) - 1
    assert steps[int(np.argmin(single))] == pytest.approx(1e-4, rel=0.25)
    assert np.all(np.diff(double) < 0)


def test_two_crowds_with_different_steps_point_alike_though_their_paths_part():
    coarse, fine = (np.array(sim_to_real._crowd(h)) for h in (0.02, 0.01))
    assert coarse.sum() == pytest.approx(100.0)
    assert np.max(np.abs(coarse - fine)) < 0.5  # of about 5.6 in each direction
    assert np.ptp(fine) > 1.5  # and the habit is one: more often down than up
    start = np.radians([160.0, -95.0])
    ends = [from_hanging(swing(start, h, round(12.0 / h))[1])[-1, 1] for h in (0.02, 0.01)]
    assert abs(ends[0] - ends[1]) > 0.5


def test_every_error_is_drawn_inside_its_panel():
    with house_style():
        figure = engines.settings()
    for axes in figure.axes:
        low, high = axes.get_xlim()
        drawn = [float(x) for line in axes.lines for x in np.atleast_1d(line.get_xdata())]
        assert all(low <= x <= high for x in drawn)


def test_an_error_of_the_reference_is_its_value_against_the_truth():
    row = reference.row("mujoco", "bounce", "default")
    assert row.value == 0.0
    assert engines.error("mujoco", "bounce", "default").mean == pytest.approx(100.0)
    swing = reference.row("dart", "double-pendulum", "tuned")
    assert engines.error("dart", "double-pendulum", "tuned").worst == pytest.approx(swing.highest)


def test_the_twin_brings_the_robot_back_to_its_speed():
    speeds = sim_to_real.driven()
    assert speeds["fixed"][-1] == pytest.approx(0.5 / 0.8, rel=1e-3)
    assert speeds["twin"][-200:].mean() == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("seed", range(5))
def test_the_learning_copy_finds_the_friction_whatever_the_noise(seed):
    assert sim_to_real.followed(seed=seed)["friction"][-1] == pytest.approx(0.8, rel=0.05)


def test_a_late_integrator_is_unstable_beyond_half_pi_over_its_delay():
    delay = 0.1
    limit = np.pi / 2 / delay
    below, above = sim_to_real.settles([0.75 * limit, 1.1 * limit], delay, 1.0)[:, 0]
    assert below < 3.0
    assert above == pytest.approx(3.0)


def test_the_wall_feels_the_mass_that_a_newton_at_the_hand_accelerates():
    arm = TwoLinkArm()
    for degrees in (1.0, 10.0, 90.0, 150.0):
        bend = np.radians(degrees)
        q = np.array([-bend / 2, bend])
        pushed = arm.jacobian(q).T @ np.array([1.0, 0.0])
        gained = arm.forward(q, np.zeros(2), pushed) - arm.forward(q, np.zeros(2), np.zeros(2))
        assert float(robots.felt(bend)) == pytest.approx(1.0 / (arm.jacobian(q) @ gained)[0], rel=1e-6)
    assert float(robots.felt(np.radians(1.0))) > 900.0
    assert float(robots.felt(np.radians(30.0))) < 2.0


def test_the_shadows_of_the_two_boxes_are_apart_and_their_upright_outlines_are_not():
    with house_style():
        left = contact.corners().axes[0]
    ends = [np.column_stack(line.get_data()) @ np.array([1.0, 1.0]) / np.sqrt(2.0) for line in left.lines]
    assert len(ends) == 2
    assert ends[1].min() - ends[0].max() == pytest.approx(1.05 * np.sqrt(2.0) - 0.5 - 0.5 * np.sqrt(2.0))
    shape, upright, other, upright_too = (patch.get_xy() for patch in left.patches)
    assert shape.max(axis=0) == pytest.approx(upright.max(axis=0))
    assert other.min(axis=0) == pytest.approx(upright_too.min(axis=0))
    assert (upright_too.min(axis=0) < upright.max(axis=0)).all()

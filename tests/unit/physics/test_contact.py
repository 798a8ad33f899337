"""Contact: geometry, the solver and what its sweeps reach, and models of one ball on one floor."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from course.physics.contact import Plane, Surface, meet, meet_plane
from course.physics.contact.impulses import Impulses, Motion, normal_speed, solve
from course.physics.contact.models import Constraint, Penalty, SoftConvex, drop, erp_cfm, slide_across
from course.physics.solver import Chain, iterations_to, stack_impulses

ORIGIN = np.zeros(3)


def test_the_gap_of_two_spheres_and_its_sign():
    normal, gap = meet(ORIGIN, np.array([0.0, 3.0, 0.0]), 1.0)
    assert gap == pytest.approx(2.0)
    assert normal.tolist() == [0.0, 1.0, 0.0]
    assert meet(ORIGIN, np.array([0.9, 0.0, 0.0]), 1.0)[1] == pytest.approx(-0.1)


def test_centres_that_coincide_still_have_a_unit_normal():
    normal, gap = meet(np.ones(3), np.ones(3), 1.0)
    assert np.linalg.norm(normal) == 1.0
    assert gap == -1.0


def test_a_sphere_below_a_plane_overlaps_it_by_more_than_its_radius():
    assert meet_plane(np.array([0.0, 0.0, -1.0]), 0.5, Plane())[1] == pytest.approx(-1.5)
    tilted = Plane((0.0, 0.0, 0.0), (0.6, 0.0, 0.8))
    normal, gap = meet_plane(np.array([1.0, 0.0, 1.0]), 0.5, tilted)
    assert gap == pytest.approx(1.4 - 0.5)
    assert normal.tolist() == [-0.6, 0.0, -0.8]  # from the sphere into the solid


@pytest.mark.parametrize("surface", [(-0.1, 0.0), (1.1, 0.0), (0.5, -1.0), (math.nan, 0.0), (0.5, math.inf)])
def test_impossible_surfaces_are_refused(surface):
    with pytest.raises(ValueError, match=r"restitution|friction"):
        Surface(*surface)


def test_a_plane_needs_a_unit_normal():
    with pytest.raises(ValueError, match="unit vector"):
        Plane(normal=(0.0, 0.0, 2.0))


vectors = st.lists(st.floats(-5, 5), min_size=3, max_size=3).map(np.array)
masses = st.floats(0.1, 10)
RADIUS = 0.5


@dataclass
class Blow:
    """Two balls, a row each, before or after a blow, and what they exchanged."""

    masses: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray  # rad/s, world axes
    push: float = 0.0
    rub: np.ndarray | float = 0.0

    def momentum(self):
        return self.masses @ self.velocity

    def energy(self):
        turning = 0.4 * RADIUS**2 * np.sum(self.spin**2, axis=1)
        return 0.5 * self.masses @ (np.sum(self.velocity**2, axis=1) + turning)


def strike(normal, v, m, e, mu, spins):
    """The second ball lies in the direction of the normal; both of radius 0.5 m, and not turning."""
    before = Blow(np.array(m), np.array(v, dtype=float), np.zeros((2, 3)))
    give = 1.0 / before.masses
    motion = Motion(before.velocity.copy(), np.zeros((2, 3)), give, 2.5 * give * spins)
    normals = normal[None, :]
    closing = -normal_speed([(0, 1)], normals, motion.velocity)
    impulses = Impulses(np.zeros(1), np.zeros((1, 3)))
    if closing[0] > 0:
        solve([(0, 1)], normals, motion, impulses, np.array([True]), e * closing, mu)
    spin = motion.rim / RADIUS
    return before, Blow(before.masses, motion.velocity, spin, impulses.push[0], impulses.rub[0])


@given(vectors, vectors, vectors, masses, masses, st.floats(0, 1), st.floats(0, 2), st.booleans())
def test_a_blow_keeps_momentum_and_never_makes_energy(place, va, vb, ma, mb, e, mu, spins):
    assume(np.linalg.norm(place) > 1e-3)
    n = place / np.linalg.norm(place)
    before, after = strike(n, (va, vb), (ma, mb), e, mu, spins)
    np.testing.assert_allclose(after.momentum(), before.momentum(), atol=1e-11)
    assert after.energy() <= before.energy() * (1 + 1e-12) + 1e-12
    # Restitution: they part at e times the speed they met at; a pair that separates is left alone.
    met, parts = (vb - va) @ n, (after.velocity[1] - after.velocity[0]) @ n
    assert parts == pytest.approx(-e * met if met < 0 else met, abs=1e-10)
    # Coulomb's cone, and friction lies in the surface.
    assert np.linalg.norm(after.rub) <= mu * after.push + 1e-10
    assert after.rub @ n == pytest.approx(0.0, abs=1e-10)
    if spins:
        # About the place of contact's first centre; moments of a solid ball.
        turned = sum(0.4 * m * RADIUS**2 * w for m, w in zip((ma, mb), after.spin, strict=True))
        carried = np.cross(2 * RADIUS * n, mb * (after.velocity[1] - vb))
        np.testing.assert_allclose(turned + carried, 0.0, atol=1e-10)


@given(vectors, vectors, vectors, st.floats(0, 1), st.floats(0, 2))
def test_a_blow_is_the_same_seen_from_a_moving_train(va, vb, train, e, mu):
    assume(abs(va[0] - vb[0]) > 1e-6)
    n = np.array([1.0, 0.0, 0.0])
    _, still = strike(n, (va, vb), (2.0, 1.0), e, mu, True)
    _, moving = strike(n, (va + train, vb + train), (2.0, 1.0), e, mu, True)
    for k in range(2):
        np.testing.assert_allclose(moving.velocity[k] - train, still.velocity[k], atol=1e-10)
        np.testing.assert_allclose(moving.spin[k], still.spin[k], atol=1e-10)


def test_enough_friction_sticks_and_takes_two_sevenths_of_a_solid_balls_slip():
    n = np.array([0.0, 0.0, -1.0])
    _, after = strike(n, ([1, 0, -1], [0, 0, 0]), (1.0, math.inf), 0.0, 10.0, True)
    v, w = after.velocity[0], after.spin[0]
    assert v[0] == pytest.approx(5 / 7)
    np.testing.assert_allclose(v + np.cross(w, RADIUS * n), 0.0, atol=1e-14)


def test_a_blow_touches_only_the_runs_it_is_told_to():
    velocity = np.zeros((2, 3, 3))
    velocity[0, :, 2] = -1.0
    motion = Motion(velocity, np.zeros_like(velocity), np.array([1.0, 0.0]), np.zeros(2))
    normal = np.broadcast_to([0.0, 0.0, -1.0], (1, 3, 3))
    impulses = Impulses(np.zeros((1, 3)), np.zeros((1, 3, 3)))
    solve([(0, 1)], normal, motion, impulses, np.array([[True, False, True]]), 1.0, 0.0)
    assert motion.velocity[0, :, 2].tolist() == [1.0, -1.0, 1.0]


# -- many contacts -----------------------------------------------------------------------------------------


def stack(boxes):
    """Boxes of 1 kg that gravity has just given -1 m/s each; body 0 is the ground."""
    pairs = [(k, k + 1) for k in range(boxes)]
    velocity = np.zeros((boxes + 1, 3))
    velocity[1:, 2] = -1.0
    give = np.array([0.0] + [1.0] * boxes)
    return (
        pairs,
        np.tile([0.0, 0.0, 1.0], (boxes, 1)),
        Motion(velocity, 0 * velocity, give, np.zeros(boxes + 1)),
    )


def test_a_stack_that_has_been_solved_takes_one_sweep_the_next_time():
    pairs, normal, motion = stack(8)
    impulses = Impulses(np.zeros(8), np.zeros((8, 3)))
    cold = solve(pairs, normal, motion, impulses, np.ones(8, dtype=bool), 0.0, 0.0)
    _, _, again = stack(8)
    warm = solve(pairs, normal, again, impulses, np.ones(8, dtype=bool), 0.0, 0.0)
    assert cold > 100
    assert warm <= 2


@given(st.integers(0, 10_000))
def test_speeds_and_impulses_are_complementary(seed):
    """A ball among four others in the plane: some contacts press, the others separate, none does both."""
    rng = np.random.default_rng(seed)
    angles = 0.5 * np.pi * np.arange(4) + rng.uniform(-0.4, 0.4, 4)
    normal = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=-1)
    velocity = rng.normal(size=(5, 3)) * [1.0, 1.0, 0.0]
    give = 1.0 / rng.uniform(0.3, 3.0, 5)
    motion = Motion(velocity.copy(), np.zeros((5, 3)), give, np.zeros(5))
    pairs = [(0, k) for k in range(1, 5)]
    impulses = Impulses(np.zeros(4), np.zeros((4, 3)))
    solve(pairs, normal, motion, impulses, np.ones(4, dtype=bool), 0.0, 0.3)
    speed = normal_speed(pairs, normal, motion.velocity)
    assert np.all(impulses.push >= 0)
    assert np.all(speed >= -1e-4)
    assert np.all(impulses.push * speed <= 1e-4)
    momentum = (motion.velocity - velocity) / give[:, None]
    np.testing.assert_allclose(momentum.sum(axis=0), 0.0, atol=1e-12)


def test_friction_is_round_so_no_direction_slides_more_easily():
    """A pyramid would let a block through at a direction between its edges; a cone does not care."""
    slid = []
    for angle in np.linspace(0.0, 0.5 * np.pi, 7):
        push = [math.cos(angle), math.sin(angle), -1.0]
        _, after = strike(np.array([0.0, 0.0, -1.0]), (push, [0, 0, 0]), (1.0, math.inf), 0.0, 0.3, False)
        slid.append(float(np.linalg.norm(after.velocity[0])))
    np.testing.assert_allclose(slid, 0.7, atol=1e-12)


# -- sweeps ----------------------------------------------------------------------------------------------


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


# -- one ball, one floor ---------------------------------------------------------------------------------

H, G = 0.01, 9.81


def lies(model, seconds=3.0):
    """How deep a ball lies after a while, m."""
    return -float(drop(model, 0.0, 0.0, H, round(seconds / H), G)[0][-1])


@given(st.floats(100.0, 1e4), st.floats(5.0, 50.0), st.floats(0.5, 2.0))
def test_a_penalty_floor_carries_a_ball_at_its_weight_over_the_stiffness(k, c, m):
    assert lies(Penalty(k, c, m), 20.0) == pytest.approx(m * G / k, rel=1e-3)


def test_a_penalty_floor_beyond_the_stability_limit_throws_the_ball():
    assert np.abs(drop(Penalty(5e4, 20.0), 0.0, 0.0, H, 300, G)[0]).max() > 1.0  # h omega = 2.2


@given(st.floats(100.0, 1e9), st.floats(0.0, 1e3), st.floats(0.5, 2.0))
def test_erp_and_cfm_are_a_spring_and_a_damper_integrated_implicitly(k, c, m):
    erp, cfm = erp_cfm(k, c, H)
    gap, v = -0.003, -0.02
    model_gap, model_v = Constraint(erp=erp, cfm=cfm, mass=m).step(gap, v, H, G)
    # (m + h c + h² k) v' = m v - h m g - h k gap
    implicit = (m * v - H * m * G - H * k * gap) / (m + H * c + H * H * k)
    assert model_v == pytest.approx(implicit, rel=1e-9, abs=1e-12)
    assert model_gap == pytest.approx(gap + H * implicit, abs=1e-12)


def test_a_constraint_holds_a_ball_exactly_and_never_pulls():
    gaps, speeds = drop(Constraint(), 0.0, 0.0, H, 100, G)
    assert not gaps.any()
    assert not speeds.any()
    leaving = drop(Constraint(), 0.0, 1.0, H, 5, G)[1]
    np.testing.assert_allclose(leaving, 1.0 - G * H * np.arange(6))


@pytest.mark.parametrize("timeconst", [0.02, 0.05])
def test_mujocos_floor_lets_every_ball_sink_as_its_impedance_says(timeconst):
    model = SoftConvex(timeconst)
    assert lies(model) == pytest.approx(model.resting_depth(G), rel=1e-6)
    flat = SoftConvex(timeconst, least=0.9, most=0.9)  # d k r = (1 - d) g, with k = 1 / (d timeconst²)
    assert flat.resting_depth(G) == pytest.approx(0.1 * G * timeconst**2)


@pytest.mark.parametrize("h", [0.01, 0.002])
def test_mujoco_itself_does_the_same_step_by_step(h):
    mujoco = pytest.importorskip("mujoco")
    world = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{h}"/><worldbody><geom type="plane" size="5 5 1"/>
        <body pos="0 0 0.52"><freejoint/><geom type="sphere" size="0.5" mass="3"/></body>
        </worldbody></mujoco>"""
    )
    data = mujoco.MjData(world)
    gaps = drop(SoftConvex(), 0.02, 0.0, h, 300, G)[0]
    for gap in gaps[1:]:
        mujoco.mj_step(world, data)
        assert data.qpos[2] - 0.5 == pytest.approx(gap, abs=1e-6)


def test_a_split_correction_takes_out_its_share_of_the_overlap_each_step():
    gaps, _ = drop(Constraint(erp=0.3, split=True), -0.02, 0.0, H, 5, G)
    np.testing.assert_allclose(gaps, -0.02 * 0.7 ** np.arange(6))


def test_below_the_threshold_nothing_bounces():
    for threshold, bounces in ((0.5, True), (1.0, False)):
        _, speeds = drop(Constraint(0.5, threshold), 0.04, 0.0, 0.001, 200, G)  # arrives at 0.89 m/s
        assert bool(np.any(speeds > 0.1)) is bounces


@given(st.floats(0.0, 0.5 * math.pi))
def test_the_cone_stops_a_block_equally_far_in_every_direction(angle):
    end = slide_across(angle, 2.0, 0.3, 1e-3, limit="cone")[-1]
    assert np.linalg.norm(end) == pytest.approx(4 / (2 * 0.3 * G) - 2.0 * 1e-3 / 2, abs=5e-6)
    assert math.atan2(end[1], end[0]) == pytest.approx(angle, abs=1e-9)


def test_the_outer_pyramid_is_the_cone_along_its_axes_and_another_floor_between_them():
    along, between, across = (
        np.linalg.norm(slide_across(angle, 2.0, 0.3, 1e-4, limit="outer")[-1])
        for angle in (0.0, math.radians(20), 0.25 * math.pi)
    )
    assert along == pytest.approx(0.6796, abs=2e-4)
    assert across == pytest.approx(along * math.sqrt(0.5), rel=1e-3)
    assert across < between < along


def test_the_inner_pyramid_is_mujocos():
    """Where MuJoCo 3.3 took a box with its default cone at 2 m/s and mu = 0.3; angles in degrees."""
    for start, far, bent in ((0, 0.679, 0.0), (20, 0.807, 32.7), (45, 0.960, 45.0)):
        end = slide_across(math.radians(start), 2.0, 0.3, 1e-3, limit="inner")[-1]
        assert np.linalg.norm(end) == pytest.approx(far, abs=1e-3)
        assert math.degrees(math.atan2(end[1], end[0])) == pytest.approx(bent, abs=0.05)


def test_a_limit_that_is_none_is_refused():
    with pytest.raises(ValueError, match="cone, outer, inner"):
        slide_across(0.0, 2.0, 0.3, 1e-3, limit="square")

"""Contact as geometry, and its solver: blows that keep what they must, loads that are carried."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from course.physics.contact import Plane, Surface, meet, meet_plane
from course.physics.contact.impulses import Impulses, Motion, normal_speed, solve

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
    """Two balls before and after a blow, and what they exchanged."""

    velocity: tuple[np.ndarray, np.ndarray]
    spin: tuple[np.ndarray, np.ndarray]  # rad/s, world axes
    push: float
    rub: np.ndarray
    masses: tuple[float, float]

    def momentum(self):
        return self.masses[0] * self.velocity[0] + self.masses[1] * self.velocity[1]

    def energy(self):
        sides = zip(self.masses, self.velocity, self.spin, strict=True)
        return sum(0.5 * m * (v @ v + 0.4 * RADIUS**2 * (w @ w)) for m, v, w in sides)


def strike(normal, v, m, e, mu, spins):
    """The second ball lies in the direction of the normal; both of radius 0.5 m, and not turning."""
    velocity = np.array(v, dtype=float)
    give = 1.0 / np.array(m)
    motion = Motion(velocity.copy(), np.zeros((2, 3)), give, 2.5 * give * spins)
    normals, still = normal[None, :], np.zeros(3)
    closing = -normal_speed([(0, 1)], normals, motion.velocity)
    impulses = Impulses(np.zeros(1), np.zeros((1, 3)))
    if closing[0] > 0:
        solve([(0, 1)], normals, motion, impulses, np.array([True]), e * closing, mu)
    rims = motion.rim / RADIUS
    before = Blow((velocity[0], velocity[1]), (still, still), 0.0, still, m)
    after = Blow(
        (motion.velocity[0], motion.velocity[1]),
        (rims[0], rims[1]),
        float(impulses.push[0]),
        impulses.rub[0],
        m,
    )
    return before, after


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

"""Contact: geometry, and blows that keep what they must and lose what restitution says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from course.physics.body import Body
from course.physics.contact import Plane, Surface, meet, meet_plane, part, slip, strike
from course.physics.state import RigidBodyState

vectors = st.lists(st.floats(-5, 5), min_size=3, max_size=3).map(np.array)
masses = st.floats(0.1, 10)


def ball(
    position: object, velocity: object, mass: float = 1.0, *, spins: bool = False, radius: float = 0.5
) -> Body:
    return Body.sphere(mass, radius, RigidBodyState.of(position, velocity), spins=spins)  # type: ignore[arg-type]


def test_the_gap_of_two_spheres_and_its_sign() -> None:
    apart = meet(ball([0, 0, 0], [0, 0, 0]), ball([0, 3, 0], [0, 0, 0]))
    assert apart.gap == pytest.approx(2.0)
    assert apart.normal.tolist() == [0.0, 1.0, 0.0]
    assert meet(ball([0, 0, 0], [0, 0, 0]), ball([0.9, 0, 0], [0, 0, 0])).gap == pytest.approx(-0.1)


def test_centres_that_coincide_still_have_a_unit_normal() -> None:
    contact = meet(ball([1, 1, 1], [0, 0, 0]), ball([1, 1, 1], [0, 0, 0]))
    assert np.linalg.norm(contact.normal) == 1.0
    assert contact.gap == -1.0


def test_a_sphere_below_a_plane_overlaps_it_by_more_than_its_radius() -> None:
    assert meet_plane(ball([0, 0, -1], [0, 0, 0]), Plane()).gap == pytest.approx(-1.5)
    tilted = Plane((0.0, 0.0, 0.0), (0.6, 0.0, 0.8))
    assert meet_plane(ball([1.0, 0.0, 1.0], [0, 0, 0]), tilted).gap == pytest.approx(1.4 - 0.5)


@given(vectors, vectors, vectors, masses, masses, st.floats(0, 1), st.floats(0, 2), st.booleans())
def test_a_blow_keeps_momentum_and_never_makes_energy(
    place: np.ndarray, va: np.ndarray, vb: np.ndarray, ma: float, mb: float, e: float, mu: float, spins: bool
) -> None:
    assume(np.linalg.norm(place) > 1e-3)
    place = place / np.linalg.norm(place)
    a, b = ball([0, 0, 0], va, ma, spins=spins), ball(place, vb, mb, spins=spins)
    contact = meet(a, b)
    before = slip(contact, a, b) @ contact.normal
    momentum, energy = a.momentum() + b.momentum(), a.kinetic_energy() + b.kinetic_energy()
    about_a = a.angular_momentum() + b.angular_momentum() + np.cross(place, b.momentum())
    impulse = strike(contact, a, b, Surface(e, mu))
    after = slip(contact, a, b) @ contact.normal
    np.testing.assert_allclose(a.momentum() + b.momentum(), momentum, atol=1e-11)
    assert a.kinetic_energy() + b.kinetic_energy() <= energy * (1 + 1e-12) + 1e-12
    # Restitution: they part at e times the speed they met at; a pair that separates is left alone.
    assert after == pytest.approx(-e * before if before < 0 else before, abs=1e-10)
    # Coulomb's cone.
    pressing = impulse @ contact.normal
    assert np.linalg.norm(impulse - pressing * contact.normal) <= mu * pressing + 1e-10
    if spins:
        spun = a.angular_momentum() + b.angular_momentum() + np.cross(place, b.momentum())
        np.testing.assert_allclose(spun, about_a, atol=1e-10)


@given(vectors, vectors, vectors, st.floats(0, 1), st.floats(0, 2))
def test_a_blow_is_the_same_seen_from_a_moving_train(
    va: np.ndarray, vb: np.ndarray, train: np.ndarray, e: float, mu: float
) -> None:
    results = []
    for shift in (np.zeros(3), train):
        a, b = ball([0, 0, 0], va + shift, 2.0, spins=True), ball([1, 0, 0], vb + shift, spins=True)
        assume(abs(va[0] - vb[0]) > 1e-6)
        strike(meet(a, b), a, b, Surface(e, mu))
        results.append((a.state.velocity - shift, b.state.velocity - shift, a.state.angular_velocity))
    for still, moving in zip(*results, strict=True):
        np.testing.assert_allclose(moving, still, atol=1e-10)


@given(masses, masses, st.floats(0.1, 5), st.floats(-5, 0))
def test_an_elastic_head_on_blow_is_the_closed_form(ma: float, mb: float, va: float, vb: float) -> None:
    a, b = ball([0, 0, 0], [va, 0, 0], ma), ball([1, 0, 0], [vb, 0, 0], mb)
    strike(meet(a, b), a, b, Surface(1.0))
    assert a.state.velocity[0] == pytest.approx(((ma - mb) * va + 2 * mb * vb) / (ma + mb), abs=1e-12)
    assert b.state.velocity[0] == pytest.approx(((mb - ma) * vb + 2 * ma * va) / (ma + mb), abs=1e-12)


def test_a_ball_thrown_at_a_wall_turns_it_round_and_the_wall_stays() -> None:
    a, wall = ball([0, 0, 0], [2, 1, 0]), ball([1, 0, 0], [0, 0, 0], math.inf)
    strike(meet(a, wall), a, wall, Surface(0.5))
    assert a.state.velocity.tolist() == [-1.0, 1.0, 0.0]
    assert not wall.state.velocity.any()


def test_enough_friction_sticks_and_takes_two_sevenths_of_a_solid_balls_slip() -> None:
    a = ball([0, 0, 0.5], [1, 0, -1], spins=True)
    contact = meet_plane(a, Plane())
    strike(contact, a, None, Surface(0.0, 10.0))
    np.testing.assert_allclose(slip(contact, a, None), 0.0, atol=1e-14)
    assert a.state.velocity[0] == pytest.approx(5 / 7)


def test_a_blow_touches_only_the_runs_it_is_told_to() -> None:
    state = RigidBodyState.of(np.zeros((3, 3)), np.tile([0.0, 0.0, -1.0], (3, 1)))
    body = Body(1.0, state)
    strike(meet_plane(body, Plane()), body, None, Surface(1.0), np.array([True, False, True]))
    assert body.state.velocity[:, 2].tolist() == [1.0, -1.0, 1.0]


def test_overlap_is_shared_out_by_inverse_mass() -> None:
    a, b = ball([0, 0, 0], [0, 0, 0], 3.0), ball([0.6, 0, 0], [0, 0, 0], 1.0)
    part(meet(a, b), a, b)
    assert meet(a, b).gap == pytest.approx(0.0, abs=1e-15)
    assert a.state.position[0] == pytest.approx(-0.1)
    assert b.state.position[0] == pytest.approx(0.9)


@pytest.mark.parametrize("surface", [(-0.1, 0.0), (1.1, 0.0), (0.5, -1.0), (math.nan, 0.0), (0.5, math.inf)])
def test_impossible_surfaces_are_refused(surface: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match=r"restitution|friction"):
        Surface(*surface)


def test_a_plane_needs_a_unit_normal() -> None:
    with pytest.raises(ValueError, match="unit vector"):
        Plane(normal=(0.0, 0.0, 2.0))

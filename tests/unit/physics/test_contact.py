"""Contact as geometry: gaps, normals, and surfaces that cannot be."""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.physics.contact import Plane, Surface, meet, meet_plane

ORIGIN = np.zeros(3)


def test_the_gap_of_two_spheres_and_its_sign() -> None:
    normal, gap = meet(ORIGIN, np.array([0.0, 3.0, 0.0]), 1.0)
    assert gap == pytest.approx(2.0)
    assert normal.tolist() == [0.0, 1.0, 0.0]
    assert meet(ORIGIN, np.array([0.9, 0.0, 0.0]), 1.0)[1] == pytest.approx(-0.1)


def test_centres_that_coincide_still_have_a_unit_normal() -> None:
    normal, gap = meet(np.ones(3), np.ones(3), 1.0)
    assert np.linalg.norm(normal) == 1.0
    assert gap == -1.0


def test_a_sphere_below_a_plane_overlaps_it_by_more_than_its_radius() -> None:
    assert meet_plane(np.array([0.0, 0.0, -1.0]), 0.5, Plane())[1] == pytest.approx(-1.5)
    tilted = Plane((0.0, 0.0, 0.0), (0.6, 0.0, 0.8))
    normal, gap = meet_plane(np.array([1.0, 0.0, 1.0]), 0.5, tilted)
    assert gap == pytest.approx(1.4 - 0.5)
    assert normal.tolist() == [-0.6, 0.0, -0.8]  # from the sphere into the solid


@pytest.mark.parametrize("surface", [(-0.1, 0.0), (1.1, 0.0), (0.5, -1.0), (math.nan, 0.0), (0.5, math.inf)])
def test_impossible_surfaces_are_refused(surface: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match=r"restitution|friction"):
        Surface(*surface)


def test_a_plane_needs_a_unit_normal() -> None:
    with pytest.raises(ValueError, match="unit vector"):
        Plane(normal=(0.0, 0.0, 2.0))

"""Contact as geometry: how far apart things are, in which direction, and what their surfaces are like.

Detection does not involve forces. ``impulses`` computes what a contact does to the bodies.

Source: Baraff and Witkin, Physically Based Modeling (SIGGRAPH course notes), 1997, part II.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Plane", "Surface", "meet", "meet_plane"]


@dataclass(frozen=True, slots=True)
class Plane:
    """The surface of a solid half-space.

    Attributes:
        point: any point of the surface, m.
        normal: unit vector out of the solid.
    """

    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        size = math.hypot(*self.normal)
        if not abs(size - 1.0) < 1e-9:
            raise ValueError(f"The normal of a plane must be a unit vector; this one has length {size:g}.")


@dataclass(frozen=True, slots=True)
class Surface:
    """How surfaces meet; each number, or an array of shape (...) with one for every run.

    Attributes:
        restitution: speed after over speed before, along the normal; 0 to 1.
        friction: Coulomb's coefficient, 0 or more.
    """

    restitution: float | Array = 1.0
    friction: float | Array = 0.0

    def __post_init__(self) -> None:
        e, mu = np.asarray(self.restitution), np.asarray(self.friction)
        if not np.all((e >= 0) & (e <= 1)):
            raise ValueError(f"A restitution lies between 0 and 1; this one is {self.restitution}.")
        if not np.all((mu >= 0) & np.isfinite(mu)):
            raise ValueError(
                f"A friction coefficient is 0 or a positive number; this one is {self.friction}."
            )


_X = np.array([1.0, 0.0, 0.0])


def meet(first: Array, second: Array, reach: float | Array) -> tuple[Array, Array]:
    """The normal and the gap of two spheres. Where the centres coincide, the normal is along x.

    Args:
        first, second: their centres, m, shape (..., 3).
        reach: the sum of their radii, m, shape (...).

    Returns:
        The normal, a unit vector from the first to the second, shape (..., 3), and the gap, the room between
        the surfaces, m, shape (...); negative where they overlap.
    """
    apart = second - first
    distance = np.sqrt((apart * apart).sum(axis=-1, keepdims=True))
    same = distance == 0.0
    normal = np.where(same, _X, apart / np.where(same, 1.0, distance))
    return normal, distance[..., 0] - reach


def meet_plane(centre: Array, radius: float | Array, plane: Plane) -> tuple[Array, Array]:
    """The same for a sphere and a plane: the normal points from the sphere into the solid."""
    outward = np.array(plane.normal)
    normal = np.empty(centre.shape)
    normal[...] = -outward
    return normal, (centre - plane.point) @ outward - radius

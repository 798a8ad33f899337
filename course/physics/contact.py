"""Contact: do two things touch, and what does the blow do to them?

Detection is geometry and knows no forces. The response is an impulse along the normal that sends the bodies
apart at ``restitution`` times the speed at which they met, and one across it, friction, that opposes sliding
and is never more than ``friction`` times the first (Coulomb's cone).

Source: Baraff and Witkin, Physically Based Modeling (SIGGRAPH course notes), 1997, part II; Stronge, Impact
Mechanics, 2000, chapter 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from course.physics.rotation import cross, turn

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from course.physics.body import Body

    Array = NDArray[np.float64]

__all__ = ["Contact", "Plane", "Surface", "meet", "meet_plane", "part", "slip", "strike"]


@dataclass(frozen=True, slots=True)
class Plane:
    """The surface of a half-space that nothing enters.

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


class Contact(NamedTuple):
    """How a first body and a second one (or a plane) lie to each other.

    Attributes:
        normal: unit vector from the first to the second, shape (..., 3).
        gap: room between the surfaces, m, shape (...); negative where they overlap.
        arm_a, arm_b: from each centre to the place of contact, m, shape (..., 3).
    """

    normal: Array
    gap: Array
    arm_a: Array
    arm_b: Array


def meet(a: Body, b: Body) -> Contact:
    """Two spheres. Where the centres coincide any direction is as good as another; this takes x."""
    apart = b.state.position - a.state.position
    distance = np.linalg.norm(apart, axis=-1, keepdims=True)
    same = distance == 0.0
    normal = np.where(same, np.array([1.0, 0.0, 0.0]), apart / np.where(same, 1.0, distance))
    return Contact(normal, distance[..., 0] - (a.radius + b.radius), a.radius * normal, -b.radius * normal)


def meet_plane(body: Body, plane: Plane) -> Contact:
    """A sphere (the first) and a plane (the second)."""
    outward = np.array(plane.normal)
    gap = (body.state.position - np.array(plane.point)) @ outward - body.radius
    normal = np.broadcast_to(-outward, body.state.position.shape)
    return Contact(normal, gap, body.radius * normal, np.zeros(3))


def slip(contact: Contact, a: Body, b: Body | None) -> Array:
    """Velocity of the second surface as the first one sees it where they touch, m/s, shape (..., 3).

    Along the normal it is negative while the two approach. ``b`` is None for a plane.
    """
    second = np.zeros(3) if b is None else _surface_velocity(b, contact.arm_b)
    return second - _surface_velocity(a, contact.arm_a)


def strike(contact: Contact, a: Body, b: Body | None, surface: Surface, where: ArrayLike = True) -> Array:
    """Let the two exchange the impulse of a blow; changes their states.

    Nothing happens to a pair that separates. Without spin the bodies part at ``restitution`` times their
    speed of approach and momentum is kept in any case.

    Args:
        b: None for a plane, which nothing moves.
        where: shape (...); False leaves that run alone.

    Returns:
        The impulse on the second body, N s, shape (..., 3).
    """
    n = contact.normal
    velocity = slip(contact, a, b)
    closing = -np.sum(velocity * n, axis=-1, keepdims=True)
    acts = np.asarray(where)[..., None] & (closing > 0)
    give = _inverse_mass(a) + _inverse_mass(b)
    if give == 0.0:
        return np.zeros_like(velocity)  # two immovable things
    pressing = np.where(acts, (1 + _column(surface.restitution)) * closing / give, 0.0)
    sliding = velocity + closing * n
    speed = np.linalg.norm(sliding, axis=-1, keepdims=True)
    # What would stop the sliding: turning gives way as well, r²/I for a sphere.
    sticking = speed / (give + _inverse_inertia(a) + _inverse_inertia(b))
    rubbing = np.minimum(_column(surface.friction) * pressing, sticking)
    impulse: Array = pressing * n - rubbing * sliding / np.where(speed == 0.0, 1.0, speed)
    a.apply_impulse(-impulse, contact.arm_a)
    if b is not None:
        b.apply_impulse(impulse, contact.arm_b)
    return impulse


def part(contact: Contact, a: Body, b: Body | None, where: ArrayLike = True) -> None:
    """Move overlapping bodies apart along the normal, the lighter one further; velocities stay."""
    from dataclasses import replace

    give = _inverse_mass(a) + _inverse_mass(b)
    if give == 0.0:
        return
    overlap = np.where(np.asarray(where), np.maximum(-contact.gap, 0.0), 0.0)[..., None]
    push = overlap / give * contact.normal
    a.state = replace(a.state, position=a.state.position - _inverse_mass(a) * push)
    if b is not None:
        b.state = replace(b.state, position=b.state.position + _inverse_mass(b) * push)


def _column(value: float | Array) -> Array:
    """A number for every run, ready to multiply vectors."""
    return np.asarray(value, dtype=float)[..., None]


def _inverse_mass(body: Body | None) -> float:
    return 0.0 if body is None else 1.0 / body.mass


def _inverse_inertia(body: Body | None) -> float:
    if body is None or not body.spins:
        return 0.0
    if np.ptp(body.inertia) > 1e-9 * body.inertia[0]:
        raise ValueError("Contacts are between spheres: the three moments of inertia must be equal.")
    return body.radius**2 / float(body.inertia[0])


def _surface_velocity(body: Body, arm: Array) -> Array:
    if not body.spins:
        return body.state.velocity
    return body.state.velocity + cross(turn(body.state.orientation, body.state.angular_velocity), arm)

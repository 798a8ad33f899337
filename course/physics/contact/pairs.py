"""Which bodies may touch, how far apart they are, and when they meet: detection for all pairs at once.

Source: Ericson, Real-Time Collision Detection, 2005, section 5.5 (moving spheres).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from course.physics.body import Body
from course.physics.contact.impulses import Flags, normal_speed
from course.physics.integrators import falling_root
from course.physics.state import Array

# ---
# Contact as geometry: how far apart things are, in which direction, and what their surfaces are like.
#
# Detection does not involve forces. ``impulses`` computes what a contact does to the bodies.
#
# Source: Baraff and Witkin, Physically Based Modeling (SIGGRAPH course notes), 1997, part II.


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


_ROUNDS = 10  # in which bodies that overlap are moved apart


class Snapshot(NamedTuple):
    """The positions of all bodies at one instant, and the normal and gap of each pair.

    Attributes:
        position, velocity: shape (B, ..., 3).
        normal, gap: of every pair, shapes (P, ..., 3) and (P, ...).
    """

    position: Array
    velocity: Array
    normal: Array
    gap: Array


class Pairs:
    """All pairs of bodies that may touch: spheres first, then spheres and the ground.

    Attributes:
        numbers: P pairs of body numbers; the ground has the number after the last body's.
        ends, first, second: the same as arrays, shapes (P, 2), (P,) and (P,).
        radius: m; give: 1/mass, 1/kg; spin_give: radius²/inertia, 1/kg, NaN where the three moments differ;
            all of shape (B + 1,) and 0 for the ground.

    Args:
        bodies: with states of the same leading axes, ``batch``.
        ground: None for none.
        spheres: False leaves out the pairs of spheres.
    """

    def __init__(
        self, bodies: Sequence[Body], ground: Plane | None, batch: tuple[int, ...], *, spheres: bool
    ) -> None:
        self.bodies, self.ground, self.batch = bodies, ground, batch
        movable = [math.isfinite(body.mass) for body in bodies]
        count = len(bodies)
        both = [(i, j) for i in range(count) for j in range(i + 1, count) if movable[i] or movable[j]]
        both = both if spheres else []
        self._spheres = len(both)
        self.numbers = both + [(i, count) for i in range(count) if ground is not None and movable[i]]
        self.ends = np.array(self.numbers, dtype=int).reshape(-1, 2)
        self.first, self.second = self.ends.T
        self.radius = np.array([body.radius for body in bodies] + [0.0])
        self.give = np.array([1.0 / body.mass for body in bodies] + [0.0])
        self.spin_give = np.array([_spin_give(body) for body in bodies] + [0.0])
        reach = self.radius[self.first] + self.radius[self.second]
        self._reach = reach.reshape(-1, *([1] * len(batch)))

    def now(self) -> Snapshot:
        """Where the bodies are, and how far apart."""
        x = np.array([body.state.position for body in self.bodies])
        v = np.array([body.state.velocity for body in self.bodies])
        n = self._spheres
        if n or self.ground is None:
            normal, gap = meet(x[self.first[:n]], x[self.second[:n]], self._reach[:n])
        if self.ground is not None:
            normal_below, below = meet_plane(x[self.first[n:]], self._reach[n:], self.ground)
            normal = np.concatenate([normal, normal_below]) if n else normal_below
            gap = np.concatenate([gap, below]) if n else below
        return Snapshot(x, v, normal, gap)

    def meetings(self, start: Snapshot, end: Snapshot, span: Array, near: float, resting: Flags) -> Array:
        """When pairs that do not rest meet on the way from ``start`` to ``end``, as a fraction of ``span``.

        Args:
            span: s, shape (...).
            near: a gap below this counts as touching, m.
            resting: pairs to leave out, shape (P, ...).

        Returns:
            Shape (P, ...); inf for a pair that does not meet.
        """
        n = self._spheres
        share = np.full(start.gap.shape, np.inf)
        # A sphere and the ground, or two that touched and part: the gap itself is followed, a cubic in time.
        followed = (end.gap < 0) & ~resting
        followed[:n] &= start.gap[:n] <= near
        if np.any(followed):
            rates = [self.speed(at) * span for at in (start, end)]
            share = np.where(followed, falling_root(start.gap, end.gap, *rates), np.inf)
        if n:
            swept = (start.gap[:n] > near) & ~resting[:n]
            share[:n] = np.where(swept, self._sweep(start, end), share[:n])
        return share

    def speed(self, at: Snapshot) -> Array:
        """How fast every pair separates, m/s, shape (P, ...)."""
        still = np.zeros((1, *at.velocity.shape[1:]))
        return normal_speed(self.ends, at.normal, np.concatenate([at.velocity, still]))

    def _sweep(self, start: Snapshot, end: Snapshot) -> Array:
        """Where two spheres first touch if each moves straight from its old place to its new one.

        A sphere that passed right through the other within the step is caught too.
        """
        a, b = self.first[: self._spheres], self.second[: self._spheres]
        moved = end.position - start.position
        old, move = start.position[b] - start.position[a], moved[b] - moved[a]
        # |old + s move|² = reach², the smaller root; closing where old . move < 0.
        half = np.sum(old * move, axis=-1)
        square = np.sum(move * move, axis=-1)
        room = np.sum(old * old, axis=-1) - self._reach[: self._spheres] ** 2
        inside = half * half - square * room
        closing = (half < 0) & (inside >= 0)
        safe = np.where(closing, np.sqrt(np.maximum(inside, 0.0)) - half, 1.0)
        return np.where(closing, np.maximum(room, 0.0) / safe, np.inf)

    def push_apart(self, near: float) -> None:
        """Move overlapping bodies apart; velocities stay, so no kinetic energy is added."""
        for _ in range(_ROUNDS):
            deep = self.now().gap < -near
            if not np.any(deep):
                break
            self.put_together(deep)

    def put_together(self, which: Flags) -> None:
        """Move the marked pairs, shape (P, ...), along their normals until their surfaces just touch.

        The lighter body moves further, so that the centre of mass stays.
        """
        for k in np.flatnonzero(in_any_run(which)):
            i, j = self.numbers[k]
            a = self.bodies[i].state.position
            if j < len(self.bodies):
                normal, gap = meet(a, self.bodies[j].state.position, self._reach[k])
            else:
                assert self.ground is not None
                normal, gap = meet_plane(a, self._reach[k], self.ground)
            shift = np.where(which[k], gap, 0.0)[..., None] * normal / (self.give[i] + self.give[j])
            self._move(i, self.give[i] * shift)
            if j < len(self.bodies):
                self._move(j, -self.give[j] * shift)

    def _move(self, i: int, shift: Array) -> None:
        state = self.bodies[i].state
        self.bodies[i].state = replace(state, position=state.position + shift)


def _spin_give(body: Body) -> float:
    if not body.spins:
        return 0.0
    if np.ptp(body.inertia) > 1e-9 * body.inertia[0]:
        return math.nan
    return body.radius**2 / float(body.inertia[0])


def in_any_run(flags: Flags) -> Flags:
    """Which pairs of shape (P, ...) are marked in any run; shape (P,)."""
    return np.asarray(flags.reshape(flags.shape[0], -1).any(axis=1))

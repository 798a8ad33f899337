"""A planar arm of two links: forward dynamics, inverse dynamics, and motion without forces.

    forward     joint torques -> joint accelerations       used by a simulator
    inverse     joint accelerations -> joint torques       used by a controller
    kinematic   a path of the hand -> joint angles         used by a planner; no masses, no forces

Angles: ``q = (q1, q2)`` in rad; q1 from the x axis, counter-clockwise, q2 from the first link. Gravity points
along -y. All functions take leading axes: q of shape (..., 2).

The two directions are derived independently, the forward one from Lagrange's equations, the inverse one link
by link from Newton's and Euler's, so that each checks the other.

Source: Craig, Introduction to Robotics, 3rd edition, 2005, chapter 6; Featherstone, Rigid Body Dynamics
Algorithms, 2008, chapter 5.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from course.physics.state import Array

_STRAIGHT = 1e-3  # sine of the elbow angle below which the hand cannot move along the arm


@dataclass(frozen=True, slots=True)
class TwoLinkArm:
    """Two links in a vertical plane, hinged at the origin and at the elbow.

    Attributes:
        length1, length2: m.
        mass1, mass2: kg.
        centre1, centre2: from each link's hinge to its centre of mass, m.
        inertia1, inertia2: about each link's centre of mass, kg m².
        g: m/s².
    """

    length1: float = 1.0
    length2: float = 1.0
    mass1: float = 1.0
    mass2: float = 1.0
    centre1: float = 0.5
    centre2: float = 0.5
    inertia1: float = 1.0 / 12.0
    inertia2: float = 1.0 / 12.0
    g: float = 9.81

    def __post_init__(self) -> None:
        for name in ("length1", "length2", "mass1", "mass2"):
            if not 0 < getattr(self, name) < float("inf"):
                raise ValueError(f"{name} must be a positive number.")
        for name, value in asdict(self).items():
            if not math.isfinite(value):
                raise ValueError(f"{name} must be a finite number, not {value}.")

    @classmethod
    def double_pendulum(cls, length: float = 1.0, mass: float = 1.0, g: float = 9.81) -> TwoLinkArm:
        """Two equal point masses at the ends of two equal rods without mass."""
        return cls(length, length, mass, mass, length, length, 0.0, 0.0, g)

    def carrying(self, mass: float) -> TwoLinkArm:
        """The same arm with a point mass (kg) in its hand."""
        whole = self.mass2 + mass
        centre = (self.mass2 * self.centre2 + mass * self.length2) / whole
        spread = self.mass2 * (centre - self.centre2) ** 2 + mass * (self.length2 - centre) ** 2
        return replace(self, mass2=whole, centre2=centre, inertia2=self.inertia2 + spread)

    def mass_matrix(self, q: ArrayLike) -> Array:
        """The matrix between accelerations and torques at rest, kg m², shape (..., 2, 2)."""
        m11, m12, m22 = self._inertias(np.asarray(q, dtype=float)[..., 1])
        rows = [[m11, m12], [m12, m22 + 0.0 * m11]]
        return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)

    def bias(self, q: ArrayLike, v: ArrayLike) -> Array:
        """Torques that hold all accelerations at 0: centrifugal, Coriolis and weight, N m, shape (..., 2)."""
        return np.stack(self._holding(np.asarray(q, dtype=float), np.asarray(v, dtype=float)), axis=-1)

    def forward(self, q: ArrayLike, v: ArrayLike, torque: ArrayLike) -> Array:
        """Forward dynamics: joint accelerations (rad/s²) from joint torques (N m); all of shape (..., 2)."""
        q, v, torque = (np.asarray(x, dtype=float) for x in (q, v, torque))
        m11, m12, m22 = self._inertias(_joints(q)[1])
        holding1, holding2 = self._holding(q, v)
        torque1, torque2 = _joints(torque)
        rest1, rest2 = torque1 - holding1, torque2 - holding2
        determinant = m11 * m22 - m12 * m12
        both = np.empty((*np.shape(determinant * rest1), 2))
        both[..., 0] = (m22 * rest1 - m12 * rest2) / determinant
        both[..., 1] = (m11 * rest2 - m12 * rest1) / determinant
        return both

    def _inertias(self, bend: Array) -> tuple[Array, Array, float]:
        """The entries 11, 12 and 22 of the mass matrix at an elbow angle."""
        swing = self.mass2 * self.length1 * self.centre2 * np.cos(bend)
        far = self.inertia2 + self.mass2 * self.centre2**2
        near = self.inertia1 + self.mass1 * self.centre1**2 + self.mass2 * self.length1**2
        return near + far + 2 * swing, far + swing, far

    def _holding(self, q: Array, v: Array) -> tuple[Array, Array]:
        """The two components of ``bias``."""
        (angle1, bend), (spin1, spin2) = _joints(q), _joints(v)
        pull = self.mass2 * self.length1 * self.centre2 * np.sin(bend)
        weight2 = self.mass2 * self.g * self.centre2 * np.cos(angle1 + bend)
        weight1 = (self.mass1 * self.centre1 + self.mass2 * self.length1) * self.g * np.cos(angle1)
        return weight1 + weight2 - pull * spin2 * (2 * spin1 + spin2), pull * spin1 * spin1 + weight2

    def inverse(self, q: ArrayLike, v: ArrayLike, acceleration: ArrayLike) -> Array:
        """Inverse dynamics: joint torques (N m) that make joint accelerations (rad/s²); shape (..., 2).

        First outward, link by link, for the acceleration of each centre of mass; then inward, for the force
        and torque at each hinge.
        """
        q, v, a = (np.asarray(x, dtype=float) for x in (q, v, acceleration))
        angle1, angle2 = q[..., 0], q[..., 0] + q[..., 1]
        spin1, spin2 = v[..., 0], v[..., 0] + v[..., 1]
        turn1, turn2 = a[..., 0], a[..., 0] + a[..., 1]
        # Being at rest in gravity is the same as accelerating upwards without it.
        up = np.array([0.0, self.g])
        elbow = up + _swing(self.length1, angle1, spin1, turn1)
        force2 = self.mass2 * (elbow + _swing(self.centre2, angle2, spin2, turn2))
        force1 = self.mass1 * (up + _swing(self.centre1, angle1, spin1, turn1))
        torque2 = self.inertia2 * turn2 + _moment(self.centre2, angle2, force2)
        torque1 = (
            self.inertia1 * turn1
            + _moment(self.centre1, angle1, force1)
            + _moment(self.length1, angle1, force2)
            + torque2
        )
        return np.stack([torque1, torque2], axis=-1)

    def energy(self, q: ArrayLike, v: ArrayLike) -> Array:
        """Kinetic and potential energy together, J, shape (...); 0 at rest, level with the shoulder."""
        q, v = np.asarray(q, dtype=float), np.asarray(v, dtype=float)
        kinetic = 0.5 * np.einsum("...i,...ij,...j->...", v, self.mass_matrix(q), v)
        height1 = self.centre1 * np.sin(q[..., 0])
        height2 = self.length1 * np.sin(q[..., 0]) + self.centre2 * np.sin(q[..., 0] + q[..., 1])
        return np.asarray(kinetic + self.g * (self.mass1 * height1 + self.mass2 * height2))

    def hand(self, q: ArrayLike) -> Array:
        """Where the end of the second link is, m, shape (..., 2)."""
        q = np.asarray(q, dtype=float)
        return self.elbow(q) + _along(self.length2, q[..., 0] + q[..., 1])

    def elbow(self, q: ArrayLike) -> Array:
        """Where the elbow is, m, shape (..., 2)."""
        return _along(self.length1, np.asarray(q, dtype=float)[..., 0])

    def jacobian(self, q: ArrayLike) -> Array:
        """Hand velocity per joint velocity, m/rad, shape (..., 2, 2)."""
        q = np.asarray(q, dtype=float)
        far = _along(self.length2, q[..., 0] + q[..., 1])
        whole = self.hand(q)
        return np.stack([_left(whole), _left(far)], axis=-1)

    def reach(self, hand: ArrayLike, *, elbow_up: bool = False) -> Array:
        """Joint angles that put the hand at a given place (inverse kinematics), rad, shape (..., 2).

        Args:
            hand: the place, m, shape (..., 2).
            elbow_up: take the other of the two solutions.

        Raises:
            ValueError: the place is out of reach.
        """
        hand = np.asarray(hand, dtype=float)
        distance_sq = np.sum(hand**2, axis=-1)
        cosine = (distance_sq - self.length1**2 - self.length2**2) / (2 * self.length1 * self.length2)
        if np.any(np.abs(cosine) > 1 + 1e-12):
            near, far = abs(self.length1 - self.length2), self.length1 + self.length2
            raise ValueError(f"The hand reaches places {near:g} m to {far:g} m from the shoulder, not these.")
        bend = np.arccos(np.clip(cosine, -1.0, 1.0)) * (-1.0 if elbow_up else 1.0)
        aim = np.arctan2(hand[..., 1], hand[..., 0])
        lean = np.arctan2(self.length2 * np.sin(bend), self.length1 + self.length2 * np.cos(bend))
        return np.stack([aim - lean, bend], axis=-1)


def _joints(x: Array) -> tuple[Array, Array]:
    """The two entries of each row of (..., 2); of a single row as numbers, which are computed with sooner."""
    first, second = x.T
    return first.T, second.T


@dataclass(frozen=True, slots=True)
class PassiveArm:
    """An arm whose joints are not driven, as a system that any stepper can integrate: a double pendulum."""

    arm: TwoLinkArm

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:  # noqa: ARG002 - a system takes (t, q, v)
        """Joint accelerations, rad/s², shape (..., 2)."""
        return self.arm.forward(q, v, np.zeros(2))


@dataclass(frozen=True, slots=True)
class HandPath:
    """A straight path of the hand, run through smoothly from rest to rest: kinematics, nothing else.

    Attributes:
        start, end: m.
        duration: s.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    duration: float

    def hand(self, t: ArrayLike) -> tuple[Array, Array, Array]:
        """Place (m), velocity (m/s) and acceleration (m/s²) of the hand; times (...,) give (..., 2)."""
        line = np.subtract(self.end, self.start)
        share, rate, change = smooth_share(np.asarray(t, dtype=float) / self.duration)
        place = np.asarray(self.start) + share[..., None] * line
        velocity: Array = rate[..., None] * line / self.duration
        acceleration: Array = change[..., None] * line / self.duration**2
        return place, velocity, acceleration

    def joints(self, arm: TwoLinkArm, t: ArrayLike) -> tuple[Array, Array, Array]:
        """Angles (rad), velocities and accelerations of the joints along the path; shapes (..., 2).

        Raises:
            ValueError: part of the path is out of reach, or so close to the limit that the joints would have
                to move too fast.
        """
        place, velocity, acceleration = self.hand(t)
        q = arm.reach(place)
        if np.any(np.abs(np.sin(q[..., 1])) < _STRAIGHT):
            raise ValueError(
                "The path comes to where the arm is straight or folded, and its joints would race."
            )
        j = arm.jacobian(q)
        v: Array = np.asarray(np.linalg.solve(j, velocity[..., None])[..., 0], dtype=np.float64)
        far = arm.hand(q) - arm.elbow(q)
        # d(J v)/dt without the accelerations: every link's end falls inwards as it turns.
        inward = -(v[..., :1] ** 2) * arm.elbow(q) - (v[..., :1] + v[..., 1:]) ** 2 * far
        a: Array = np.asarray(
            np.linalg.solve(j, (acceleration - inward)[..., None])[..., 0], dtype=np.float64
        )
        return q, v, a


@dataclass(frozen=True, slots=True)
class DrivenArm:
    """An arm under the torques that were planned for another one, as a system that any stepper can integrate.

    Attributes:
        arm: the one that moves.
        planned: the one that the torques along ``path`` were computed for.
        stiffness, damping: of the feedback, N m/rad and N m s/rad: times the errors of the joints.
    """

    arm: TwoLinkArm
    planned: TwoLinkArm
    path: HandPath
    stiffness: float = 0.0
    damping: float = 0.0

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        """Joint accelerations, rad/s², shape (..., 2)."""
        wanted, rate, change = self.path.joints(self.planned, t)
        correction = self.stiffness * (wanted - np.asarray(q)) + self.damping * (rate - np.asarray(v))
        return self.arm.forward(q, v, self.planned.inverse(wanted, rate, change) + correction)


def smooth_share(s: ArrayLike) -> tuple[Array, Array, Array]:
    """The fraction of the path covered at the fraction s of the time, with first and second derivative.

    This is the polynomial of degree five that begins and ends at rest with zero acceleration.

    Source: Flash and Hogan, J. Neuroscience 5, 1985 (minimum jerk).
    """
    x: Array = np.clip(np.asarray(s, dtype=float), 0.0, 1.0)
    share = x**3 * (10 - 15 * x + 6 * x * x)
    return share, 30 * x**2 * (1 - x) ** 2, 60 * x * (1 - x) * (1 - 2 * x)


def _along(length: float, angle: Array) -> Array:
    """A vector of this length in this direction, shape (..., 2)."""
    return length * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _left(vector: Array) -> Array:
    """The vector turned a quarter counter-clockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


def _swing(length: float, angle: Array, spin: Array, turn: Array) -> Array:
    """Acceleration of the end of a turning rod relative to its hinge, m/s²."""
    rod = _along(length, angle)
    return turn[..., None] * _left(rod) - spin[..., None] ** 2 * rod


def _moment(length: float, angle: Array, force: Array) -> Array:
    """Torque about the hinge of a force at the end of a rod, N m."""
    rod = _along(length, angle)
    return np.asarray(rod[..., 0] * force[..., 1] - rod[..., 1] * force[..., 0])

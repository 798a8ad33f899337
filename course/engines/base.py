"""The interface of every engine: build a scene, step it, report the motion.

Scenes are three-dimensional, z up, in SI units. Bodies are balls and cubes, whose inertia is the same about
every axis, so that mechanical energy needs no orientation. An engine in the plane uses x and z.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from course.errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = [
    "AS_IT_COMES",
    "Adapter",
    "Body",
    "EngineDivergedError",
    "Motion",
    "NotApplicableError",
    "Scene",
    "Tuning",
    "Wall",
    "World",
    "energy",
    "momentum",
]

Vector = tuple[float, float, float]


class EngineDivergedError(CourseError):
    """An engine gave a position or a velocity that is not a number."""

    default_code = "engine_diverged"


class NotApplicableError(CourseError):
    """A scene needs something that an engine cannot express."""

    default_code = "not_applicable"


@dataclass(frozen=True, slots=True)
class Body:
    """A body that moves.

    Attributes:
        shape: ``ball`` or ``cube``.
        size: radius or half an edge, m.
        mass: kg.
        position: of the centre, m.
        velocity: m/s.
    """

    shape: Literal["ball", "cube"]
    size: float
    mass: float
    position: Vector
    velocity: Vector = (0.0, 0.0, 0.0)

    @property
    def inertia(self) -> float:
        """About any axis through the centre, kg m²."""
        return (0.4 if self.shape == "ball" else 2.0 / 3.0) * self.mass * self.size**2


@dataclass(frozen=True, slots=True)
class Wall:
    """A box that does not move: its centre and half its edges, m."""

    position: Vector
    half: Vector


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything an engine needs to know.

    Attributes:
        bodies: those that move, in the order in which ``World.motion`` reports them.
        gravity: m/s².
        friction, restitution: the coefficients that must act between any two surfaces. An adapter sets the
            values that its engine's rule for two materials turns into these.
        floor: there is a plane z = 0.
        walls: fixed boxes.
        pivots: for a chain: body i hangs by a hinge about the y axis at ``pivots[i]`` on body i - 1, the
            first on the world. Bodies of a chain do not collide.
        dt: the step, s.
    """

    bodies: tuple[Body, ...]
    gravity: Vector = (0.0, 0.0, -9.81)
    friction: float = 0.0
    restitution: float = 0.0
    floor: bool = False
    walls: tuple[Wall, ...] = ()
    pivots: tuple[Vector, ...] = ()
    dt: float = 1.0 / 240.0


@dataclass(frozen=True, slots=True)
class Motion:
    """Where the bodies are.

    Attributes:
        x: centres, (n, 3), m.
        v: velocities of the centres, (n, 3), m/s.
        w: angular velocities, (n, 3), rad/s, in the world's axes.
    """

    x: Array
    v: Array
    w: Array

    def checked(self) -> Motion:
        """Itself.

        Raises:
            EngineDivergedError: something in it is not a number.
        """
        if not all(np.isfinite(part).all() for part in (self.x, self.v, self.w)):
            raise EngineDivergedError("A position or a velocity stopped being a number.")
        return self


class World(Protocol):
    """A scene inside an engine."""

    def step(self, n: int = 1) -> None:
        """Advance by ``n`` steps of the scene's length."""

    def motion(self) -> Motion:
        """The state after the steps so far; arrays of its own."""

    def contacts(self) -> tuple[int, float]:
        """The number of contact points and their deepest overlap in m, in the last step."""


@dataclass(frozen=True, slots=True)
class Tuning:
    """Options that differ from an engine's defaults, and why.

    Attributes:
        options: as the adapter's ``build`` takes them.
        why: one sentence per option, in the same order.
    """

    options: Mapping[str, Any] = field(default_factory=dict)
    why: tuple[str, ...] = ()


#: The engine with its own defaults.
AS_IT_COMES = Tuning()


class Adapter(Protocol):
    """One engine."""

    def build(self, scene: Scene, options: Mapping[str, Any]) -> World:
        """Put a scene into the engine.

        Args:
            options: empty for the engine as it comes; otherwise the result of ``settings.tuning``.

        Raises:
            NotApplicableError: the engine cannot express the scene.
        """


def energy(scene: Scene, motion: Motion) -> float:
    """Kinetic energy plus potential energy in the scene's gravity, J; zero height is the origin."""
    mass = np.array([body.mass for body in scene.bodies])
    inertia = np.array([body.inertia for body in scene.bodies])
    kinetic = 0.5 * (mass * (motion.v**2).sum(1)).sum() + 0.5 * (inertia * (motion.w**2).sum(1)).sum()
    return float(kinetic - (mass * (motion.x @ np.array(scene.gravity))).sum())


def momentum(scene: Scene, motion: Motion) -> Array:
    """Total linear momentum, (3,), kg m/s."""
    return np.array([body.mass for body in scene.bodies]) @ motion.v

"""A body: its mass and inertia, its state, and the forces that act on it now."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from course.physics.rotation import angular_momentum, kinetic_energy
from course.physics.state import Array, RigidBodyState


class Body:
    """A rigid body with a mass, principal moments of inertia and, for contacts, the shape of a sphere.

    Forces and torques add up until they are cleared, so that gravity, a spring and a motor need not know
    about each other.

    Args:
        mass: kg; ``math.inf`` for a body that cannot be moved.
        state: where it is; may hold many runs at once.
        inertia: principal moments about the body's axes, shape (3,), kg m². ``math.inf`` (the default) makes
            a body that never turns: a point mass.
        radius: of the sphere it touches others with, m; 0 for a point.

    Raises:
        ValueError: a mass or a moment is not positive, the radius is negative, or the moments are those of
            no real body (one larger than the other two together).
    """

    def __init__(
        self, mass: float, state: RigidBodyState, *, inertia: ArrayLike = math.inf, radius: float = 0.0
    ) -> None:
        if not mass > 0:
            raise ValueError(f"A mass must be positive, in kg; this one is {mass}.")
        if not 0 <= radius < math.inf:
            raise ValueError(f"A radius must be 0 or a positive number, in m; this one is {radius}.")
        moments = np.array(np.broadcast_to(np.asarray(inertia, dtype=float), (3,)))
        if not np.all(moments > 0):
            raise ValueError(f"Moments of inertia must be positive, in kg m²; these are {moments.tolist()}.")
        if np.all(np.isfinite(moments)) and 2 * moments.max() > moments.sum() * (1 + 1e-12):
            raise ValueError(
                f"No body has the moments {moments.tolist()}: none may exceed the sum of the other two."
            )
        self.mass = float(mass)
        self.inertia = moments
        #: True if a torque can turn it.
        self.spins = bool(np.all(np.isfinite(moments)))
        self.radius = float(radius)
        self.state = state
        self.force: Array = np.zeros(3)
        self.torque: Array = np.zeros(3)

    @classmethod
    def sphere(cls, mass: float, radius: float, state: RigidBodyState, *, spins: bool = True) -> Body:
        """A solid ball, inertia 2/5 m r²; with ``spins=False`` one that friction cannot make turn."""
        inertia = 0.4 * mass * radius**2 if spins and radius > 0 else math.inf
        return cls(mass, state, inertia=inertia, radius=radius)

    def add_force(self, force: ArrayLike) -> None:
        """Push at the centre of mass: N, in the world's axes, shape (..., 3)."""
        self.force = self.force + np.asarray(force, dtype=float)

    def add_torque(self, torque: ArrayLike) -> None:
        """Twist: N m, in the world's axes, shape (..., 3)."""
        self.torque = self.torque + np.asarray(torque, dtype=float)

    def clear(self) -> None:
        """Forget all forces and torques."""
        self.force, self.torque = np.zeros(3), np.zeros(3)

    def acceleration(self) -> Array:
        """Newton's second law: the acceleration by the forces so far, m/s², shape (..., 3)."""
        return self.force / self.mass

    def momentum(self) -> Array:
        """Mass times velocity, kg m/s, shape (..., 3)."""
        return self.mass * self.state.velocity

    def angular_momentum(self) -> Array:
        """About the centre of mass, in the world's axes, kg m²/s; 0 for a body that never turns."""
        if not self.spins:
            return np.zeros_like(self.state.angular_velocity)
        return angular_momentum(self.inertia, self.state.orientation, self.state.angular_velocity)

    def kinetic_energy(self) -> Array:
        """Of the motion and of the rotation together, J, shape (...)."""
        linear = 0.5 * self.mass * np.sum(self.state.velocity**2, axis=-1)
        if not self.spins:
            return np.asarray(linear)
        return np.asarray(linear + kinetic_energy(self.inertia, self.state.angular_velocity))

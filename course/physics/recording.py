"""A run as it was sampled: where everything was, and what follows from it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from course.physics.rotation import kinetic_energy

if TYPE_CHECKING:
    Array = NDArray[np.float64]

__all__ = ["Recording"]


@dataclass(frozen=True, eq=False)
class Recording:
    """A run: n + 1 samples, the start included, of B bodies; ``...`` are the leading axes of their states.

    Attributes:
        t: shape (n + 1,), s.
        position, velocity: shape (n + 1, B, ..., 3), m and m/s.
        orientation: shape (n + 1, B, ..., 4). angular_velocity: (n + 1, B, ..., 3), rad/s, body axes.
        mass: shape (B,), kg. inertia: shape (B, 3), kg m². gravity: m/s².
        first_contact: pairs of body numbers (None is the ground) -> the time they first met, s, shape (...);
            NaN where they did not.
    """

    t: Array
    position: Array
    velocity: Array
    orientation: Array
    angular_velocity: Array
    mass: Array
    inertia: Array
    gravity: float
    first_contact: dict[tuple[int, int | None], Array] = field(default_factory=dict)

    @property
    def ground_time(self) -> Array:
        """When each body first met the ground, s, shape (B, ...); NaN where it did not, or there is none."""
        never = np.full(self.position.shape[2:-1], np.nan)
        return np.stack([self.first_contact.get((i, None), never) for i in range(self.mass.size)])

    def momentum(self) -> Array:
        """Total momentum, kg m/s, shape (n + 1, ..., 3)."""
        return np.asarray(np.tensordot(self.mass, self.velocity, axes=(0, 1)))

    def energy(self) -> Array:
        """Total energy, motion, rotation and height together, J, shape (n + 1, ...)."""
        total = np.zeros(self.position.shape[:1] + self.position.shape[2:-1])
        for i, mass in enumerate(self.mass):
            total += 0.5 * mass * np.sum(self.velocity[:, i] ** 2, axis=-1)
            total += mass * self.gravity * self.position[:, i, ..., 2]
            if np.all(np.isfinite(self.inertia[i])):
                total += kinetic_energy(self.inertia[i], self.angular_velocity[:, i])
        return total

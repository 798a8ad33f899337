"""The account of energy and momentum, kept in blocks of steps.

A step of pymunk is: move every body by ``v h``; find the contacts; add ``g h`` to every velocity; change
velocities by impulses at contacts and joints. From ``v0`` to ``v1`` a body gains ``(m g h + P)(v0 + v1)/2``,
with ``P`` the sum of its impulses, and that is exact: gravity's part and that of the impulses are the two
terms. A body that rests gains and loses nothing in this way of counting. Friction's share is known contact by
contact: impulse along the surface times the mean of the sliding speed before and after.

A Python callback in each contact would cost more than the physics. Instead, two calls that stay in C copy
velocities and impulses after each step, and the arithmetic is done for many steps at once. That is safe:
nothing changes them before the next step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.sandbox.scene.parts import Part

__all__ = ["COLUMNS", "Block", "Contacts", "Ledger"]

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]

#: Columns of a state: a row per body.
COLUMNS = ("x", "y", "angle", "vx", "vy", "spin")


@dataclass(frozen=True, slots=True)
class Contacts:
    """All contacts of some steps, a row each.

    Attributes:
        row: which step of the block, 0 first.
        a, b: indices of the bodies.
        first: 1 where the two did not touch in the step before.
        impulse: on ``a``, in N s, (n, 2).
        normal: from ``a`` to ``b``, (n, 2).
        point: in m, (n, 2).
    """

    row: Ints
    a: Ints
    b: Ints
    first: NDArray[np.uint64]
    impulse: Floats
    normal: Floats
    point: Floats


@dataclass(frozen=True, slots=True)
class Block:
    """A few consecutive steps.

    Attributes:
        first_step: number of the first of them.
        times: at their ends, in s, (k,).
        before: velocities and spin at the start of each step, (k, n, 3).
        states: state at the end of each, (k, n, 6), columns as in ``COLUMNS``. Like the contacts these
            are the engine's own memory: good until the next step, so copy what is to be kept.
        contacts: during them.
    """

    first_step: int
    times: Floats
    before: Floats
    states: Floats
    contacts: Contacts


class Ledger:
    """Sums of the losses, by place.

    Args:
        parts: the bodies, in the order of the rows of every state.
        gravity: in m/s².
        joints: whether joints do work as well; their errors then go to the residual.
    """

    def __init__(self, parts: Sequence[Part], gravity: tuple[float, float], *, joints: bool) -> None:
        self.contacts = 0.0
        self.friction = 0.0
        self.rods = 0.0
        self.integrator = 0.0
        self.given = 0.0
        self.start = 0.0
        self.joints = joints
        self.adopt(parts, gravity)

    def adopt(self, parts: Sequence[Part], gravity: tuple[float, float]) -> None:
        """Switch to another set of bodies, or another gravity; the sums stay."""
        finite = [p.moment if np.isfinite(p.moment) else 0.0 for p in parts]
        self.mass = np.array([p.mass for p in parts])
        self.inertia = np.array(finite)
        self.gravity = gravity
        self._weights = np.column_stack([self.mass, self.mass, self.inertia]).ravel() / 2
        self._heights = np.column_stack([-self.mass * gravity[0], -self.mass * gravity[1]]).ravel()
        forces = [self.mass * gravity[0], self.mass * gravity[1], 0.0 * self.mass]
        self._weight_force = np.column_stack(forces).ravel()

    # -- of one state ----------------------------------------------------------------------------

    def kinetic(self, state: Floats) -> float:
        """In J; state (n, 6)."""
        v = state[:, 3:].ravel()
        return float((v * v) @ self._weights)

    def potential(self, state: Floats) -> float:
        """In J; state (n, 6)."""
        return float(state[:, :2].ravel() @ self._heights)

    def momentum(self, state: Floats) -> tuple[float, float, float]:
        """Along x and y in kg m/s, and angular about the origin in kg m²/s; state (n, 6)."""
        x, y, _, vx, vy, spin = state.T
        angular = self.mass @ (x * vy - y * vx) + self.inertia @ spin
        return float(self.mass @ vx), float(self.mass @ vy), float(angular)

    # -- of many steps ---------------------------------------------------------------------------

    def settle(self, block: Block, step: float, given: Floats | float = 0.0) -> tuple[Floats, Floats]:
        """Book the losses of a block.

        Args:
            block: the steps.
            step: their size, in s.
            given: what a hand gave in each step, (k,), in J.

        Returns:
            what each step lost at contacts, (k,), and by friction, (k,), in J.
        """
        count = len(block.times)
        before, after = block.before, block.states[:, :, 3:]
        mean = (before + after) / 2
        from_gravity = mean.reshape(count, -1) @ self._weight_force * step
        contacts, friction = self._of_contacts(block, mean, count)
        if not self.joints and len(block.contacts.row):
            gained = self.energies(after) - self.energies(before)
            contacts = from_gravity + given - gained - friction
        self.contacts += float(contacts.sum())
        self.friction += float(friction.sum())
        self.integrator += float((before[0] - after[-1]).ravel() @ self._weight_force) * step / 2
        return contacts, friction

    def energies(self, velocities: Floats) -> Floats:
        """Kinetic energies of several states, (k,), in J; velocities (k, n, 3)."""
        energies: Floats = (velocities * velocities).reshape(len(velocities), -1) @ self._weights
        return energies

    def table(self, states: Floats) -> Floats:
        """Kinetic and potential energy, and momentum along x, y and about the origin, of states (k, n, 6)."""
        x, y, vx, vy, spin = (states[:, :, i] for i in (0, 1, 3, 4, 5))
        heights = states[:, :, :2].reshape(len(states), -1) @ self._heights
        angular = (x * vy - y * vx) @ self.mass + spin @ self.inertia
        return np.column_stack(
            [self.energies(states[:, :, 3:]), heights, vx @ self.mass, vy @ self.mass, angular]
        )

    def work(self, block: Block, impulses: Floats) -> Floats:
        """What impulses gave that acted inside the steps, (k,), in J.

        Args:
            block: the steps.
            impulses: (k, n, 3), in N s and N m s.
        """
        work: Floats = ((block.before + block.states[:, :, 3:]) * impulses).sum(axis=(1, 2)) / 2
        return work

    def _of_contacts(self, block: Block, mean: Floats, count: int) -> tuple[Floats, Floats]:
        """Energy that impulses took along normals and along surfaces, by step.

        The velocity of a body's point p is ``(vx + w y - w py, vy - w x + w px)``: what does not depend on p
        is computed once per body, and only three numbers per body are looked up for each contact.
        """
        c = block.contacts
        zero = np.zeros(count)
        if not len(c.row):
            return zero, zero
        spin = mean[:, :, 2]
        field = np.stack(
            [mean[:, :, 0] + spin * block.states[:, :, 1], mean[:, :, 1] - spin * block.states[:, :, 0], spin]
        ).reshape(3, -1)
        start = c.row * mean.shape[1]
        a, b = start + c.a, start + c.b
        vx, vy, turn = (column.take(b) - column.take(a) for column in field)
        # Columns once, side by side: reading them out of wide rows again and again costs more.
        px, py = c.point.T.copy()
        nx, ny = c.normal.T.copy()
        jx, jy = c.impulse.T.copy()
        vx -= turn * py
        vy += turn * px
        along = (jy * nx - jx * ny) * (vy * nx - vx * ny)
        friction: Floats = np.bincount(c.row, weights=along, minlength=count).astype(np.float64)
        if not self.joints:
            return zero, friction
        across = (jx * nx + jy * ny) * (vx * nx + vy * ny)
        return np.bincount(c.row, weights=across, minlength=count).astype(np.float64), friction

"""The impulses of all contacts at once: a complementarity problem, solved one contact after the other.

A contact can push but not pull, and a pair may separate but not approach. With ``push`` the impulse along the
normal and ``speed`` the normal velocity afterwards,

    push >= 0,    speed >= target,    push (speed - target) = 0

where ``target`` follows from the restitution for a pair that collides, and is 0 for one that rests: an impact
and a support are the same constraint. Friction stops sliding if an impulse of at most ``friction * push`` is
enough, and otherwise opposes it with exactly that impulse (Coulomb's round cone). Contacts that share a body
depend on one another, so all of them have to be solved together.

Projected Gauss-Seidel solves them in turn: a contact's missing impulse is added to its impulse, the sum is
projected back into the allowed range (not below 0, not outside the cone), and its two bodies get the
difference at once. The sweeps over all contacts go on until a sweep changes nothing. Starting from the
impulses of the last step (*warm starting*) saves almost all sweeps where bodies are at rest.

Source: Stewart and Trinkle, Int. J. Numerical Methods in Engineering 39, 1996, and Anitescu and Potra,
Nonlinear Dynamics 14, 1997 (contact as complementarity of velocities); Catto, Iterative Dynamics with
Temporal Coherence, 2005 (projected Gauss-Seidel with warm starting).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from course.physics.state import Array

Flags = NDArray[np.bool_]

_DONE = 1e-6  # the last sweep changes no velocity by more than this fraction of the target
_SWEEPS = 500  # then the step uses what it has, as every engine does; the next one starts from it


@dataclass(slots=True)
class Motion:
    """How bodies move at one instant; ``solve`` changes it. The bodies are spheres or immovable.

    Attributes:
        velocity: m/s, shape (B, ..., 3).
        rim: radius times angular velocity, in the world's axes, m/s, shape (B, ..., 3).
        give: 1/mass, 1/kg, shape (B,); 0 for a body that cannot be moved.
        spin_give: radius²/inertia, 1/kg, shape (B,); 0 for a body that cannot be turned.
    """

    velocity: Array
    rim: Array
    give: Array
    spin_give: Array

    def copy(self) -> Motion:
        """The same motion, to be changed by itself; of the same bodies."""
        return Motion(self.velocity.copy(), self.rim.copy(), self.give, self.spin_give)


@dataclass(slots=True)
class Impulses:
    """The impulses of every pair on its second body: along the normal, N s, shape (P, ...), and across it."""

    push: Array
    rub: Array  # shape (P, ..., 3)


def normal_speed(pairs: ArrayLike, normal: Array, velocity: Array) -> Array:
    """How fast the bodies of each pair separate, m/s, shape (P, ...); negative while they approach."""
    first, second = np.asarray(pairs, dtype=int).reshape(-1, 2).T
    apart: Array = (velocity[second] - velocity[first]) * normal
    return np.asarray(apart.sum(axis=-1))


def solve(
    pairs: Sequence[tuple[int, int]],
    normal: Array,
    motion: Motion,
    impulses: Impulses,
    active: Flags,
    target: float | Array,
    friction: float | Array,
) -> int:
    """Find the impulses of the active contacts and let them act; changes ``motion`` and ``impulses``.

    Args:
        pairs: P pairs of body numbers.
        normal: unit vectors from the first body to the second, shape (P, ..., 3).
        impulses: where to start; 0 for a pair that is not active.
        active: which pairs touch, shape (P, ...).
        target: the smallest allowed normal velocity afterwards, m/s, shape (P, ...) or a number.
        friction: Coulomb's coefficient, shape (...).

    Returns:
        The number of sweeps it took, at most 500.
    """
    sweep = 0
    touching = np.flatnonzero(active.reshape(len(pairs), -1).any(axis=1)).tolist()
    contacts = _contacts([pairs[k] for k in touching], normal[touching], motion)
    push, rub = impulses.push[touching], impulses.rub[touching]
    wanted, on = np.broadcast_to(target, active.shape)[touching], active[touching]
    lacking = np.abs(wanted - normal_speed(pairs, normal, motion.velocity)[touching])
    enough = _DONE * float(np.max(lacking, where=on, initial=0.0))
    rough = bool(np.any(np.asarray(friction) > 0))
    give = np.array([contact.give for contact in contacts]).reshape(-1, *([1] * (push.ndim - 1)))
    for k, contact in enumerate(contacts):  # warm start: the impulses given act first
        rub[k] = contact.across(rub[k])
        contact.exchange(motion, push[k][..., None] * contact.normal + rub[k], rough)
    for sweep in range(1, _SWEEPS + 1):  # noqa: B007 - its last value is the answer
        old_push, old_rub = push.copy(), rub.copy()
        for k, contact in enumerate(contacts):
            apart = motion.velocity[contact.j] - motion.velocity[contact.i]
            speed = np.einsum("...i,...i->...", apart, contact.normal)
            push[k] = np.maximum(push[k] + (wanted[k] - speed) / contact.give, 0.0) * on[k]
            impulse = (push[k] - old_push[k])[..., None] * contact.normal
            if rough:
                slip = contact.slip(apart, motion)
                rub[k] = _within(friction * push[k], rub[k] - slip / contact.slip_give)
                impulse += rub[k] - old_rub[k]
            contact.exchange(motion, impulse, rough)
        change = np.maximum(np.abs(push - old_push), np.abs(rub - old_rub).max(axis=-1))
        if np.all(give * change <= enough):
            break
    impulses.push[touching], impulses.rub[touching] = push, rub
    return sweep


@dataclass(slots=True)
class _Contact:
    """Two bodies that touch, and the quantities that their contact uses repeatedly."""

    i: int
    j: int
    normal: Array
    give: float  # normal velocity per impulse, 1/kg
    slip_give: float  # the same across: turning gives way as well
    onto: Array  # the matrix that leaves out what is along the normal, shape (..., 3, 3)
    about: Array  # the matrix of the cross product with the normal: about @ x = normal x x
    turns: bool

    def across(self, vector: Array) -> Array:
        """The part of a vector that lies in the surface."""
        return np.asarray((self.onto @ vector[..., None])[..., 0])

    def slip(self, apart: Array, motion: Motion) -> Array:
        """How fast the second surface slides over the first, m/s, where the centres part at ``apart``."""
        sliding = self.across(apart)
        if self.turns:
            rims = motion.rim[self.i] + motion.rim[self.j]
            sliding += (self.about @ rims[..., None])[..., 0]
        return sliding

    def exchange(self, motion: Motion, impulse: Array, rough: bool) -> None:
        """Let an impulse (N s, on the second body) act on both where they touch."""
        i, j = self.i, self.j
        motion.velocity[i] -= motion.give[i] * impulse
        motion.velocity[j] += motion.give[j] * impulse
        if rough and self.turns:
            twist = (self.about @ impulse[..., None])[..., 0]
            motion.rim[i] -= motion.spin_give[i] * twist
            motion.rim[j] -= motion.spin_give[j] * twist


def _contacts(pairs: Sequence[tuple[int, int]], n: Array, motion: Motion) -> list[_Contact]:
    onto = np.eye(3) - n[..., :, None] * n[..., None, :]
    about = np.zeros((*n.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        about[..., i, j], about[..., j, i] = -n[..., k], n[..., k]
    found = []
    for k, (i, j) in enumerate(pairs):
        give, spin = (float(of[i] + of[j]) for of in (motion.give, motion.spin_give))
        found.append(_Contact(i, j, n[k], give, give + spin, onto[k], about[k], spin > 0))
    return found


def _within(limit: Array, vector: Array) -> Array:
    """The vector, shortened to the limit where it is longer: the projection onto a disc."""
    size = np.sqrt(np.einsum("...i,...i->...", vector, vector))
    return vector * np.minimum(1.0, limit / np.where(size == 0.0, 1.0, size))[..., None]

"""Scenes of the two simulations of ``collisions``, and paths between contacts that are known.

Between contacts a head-on pair moves on straight lines and a ball in the air on parabolas. When contacts
come and how fast bodies leave them is not computed here: it comes from the reference of a grading run, or,
for the fixed scenes of the public checks, from ``hypotheses.json``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class HeadOn:
    """The scene of ``simulate_head_on``: masses kg, positions m, velocities m/s, lengths m."""

    m: tuple[float, float]
    x0: tuple[float, float]
    v0: tuple[float, float]
    radius: float
    restitution: float

    def at(self, t, contact, after, wait=0.0):
        """Positions and velocities at times t, each of shape (n, 2).

        contact: when they touch, s; after: velocities then, m/s; wait: pause between, s.
        """
        t = np.asarray(t, dtype=float)[:, None]
        x0, v0 = np.array(self.x0), np.array(self.v0)
        if not contact < math.inf:
            return x0 + v0 * t, np.broadcast_to(v0, (len(t), 2))
        v1 = np.array(after)
        x = x0 + v0 * np.minimum(t, contact) + v1 * np.maximum(t - contact - wait, 0.0)
        return x, np.where(t <= contact, v0, v1)

    def args(self, t_end, h, pack=np.array):
        """What ``simulate_head_on`` is called with."""
        return pack(self.m), pack(self.x0), pack(self.v0), self.radius, self.restitution, t_end, h

    def shown(self, t_end, h):
        """The same as a finding shows it."""
        names = ("m", "x0", "v0", "radius", "restitution", "t_end", "h")
        return dict(zip(names, self.args(t_end, h, list), strict=True))


@dataclass(frozen=True)
class Drop:
    """The scene of ``simulate_drop``: a ball above the floor z = 0, in m, m/s and m/s²."""

    z0: float
    v0: float
    radius: float
    restitution: float
    g: float = 9.81

    @property
    def fastest(self):
        """Speed at which it first reaches the floor, m/s: by its energy, whatever it does later."""
        return math.sqrt(self.v0**2 + 2 * self.g * max(self.z0 - self.radius, 0.0))

    def at(self, t, times, speeds):
        """Heights and velocities at times t, each of shape (n,).

        times: of the contacts, s; speeds: upwards after each, m/s, 0 where the ball rests from then on.
        """
        t, times, speeds = (np.asarray(part, dtype=float) for part in (t, times, speeds))
        last = np.searchsorted(times, t, side="left") - 1
        bounced = (last >= 0) if len(times) else np.zeros(len(t), dtype=bool)
        start = np.where(bounced, times[last], 0.0) if len(times) else 0.0
        up = np.where(bounced, speeds[last], self.v0) if len(times) else np.full(len(t), self.v0)
        rests = bounced & (up == 0.0)
        s = t - start
        z = np.where(bounced, self.radius, self.z0) + np.where(rests, 0.0, up * s - self.g * s * s / 2)
        return z, np.where(rests, 0.0, up - self.g * s)

    def args(self, t_end, h):
        """What ``simulate_drop`` is called with."""
        return self.z0, self.v0, self.radius, self.restitution, self.g, t_end, h

    def shown(self, t_end, h):
        """The same as a finding shows it."""
        names = ("z0", "v0", "radius", "restitution", "g", "t_end", "h")
        return dict(zip(names, self.args(t_end, h), strict=True))


@dataclass(frozen=True)
class Meeting:
    """What happens in a ``HeadOn``: when they touch, s (inf: never), and the velocities after, m/s."""

    contact: float
    after: tuple[float, float]


@dataclass(frozen=True)
class Bounces:
    """What happens in a ``Drop``, with a step of h.

    times, speeds: of its contacts, s, and upwards after each, m/s; 0 where it rests from then on.
    may, must: from when on it may rest, and from when on it must, s. Whether the speed before or after a
    contact is compared with g h decides between two neighbouring contacts; both readings are right.
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]
    may: float
    must: float


def hopping(scene, bounces):
    """The speeds of ``bounces``, m/s, if the ball leaves its last contact, too: with e times its speed."""
    if not bounces.speeds:
        return ()
    before = bounces.speeds[-2] if len(bounces.speeds) > 1 else scene.fastest
    return *bounces.speeds[:-1], bounces.speeds[-1] or scene.restitution * before

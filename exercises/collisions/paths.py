"""Where the two simulations of ``collisions`` must lead: paths in closed form, without any step.

Between contacts a head-on pair moves on straight lines and a ball in the air on parabolas, so each path is
known as soon as its contacts are.
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

    @property
    def closing(self):
        """Speed of approach, m/s; zero or negative if they never meet."""
        return self.v0[0] - self.v0[1]

    @property
    def contact(self):
        """When they touch, s; inf if they never do."""
        gap = self.x0[1] - self.x0[0] - 2 * self.radius
        return gap / self.closing if self.closing > 0 else math.inf

    def after(self, factor=None, give=None):
        """Both velocities after the blow, m/s; ``factor`` and ``give`` replace 1 + e and 1/ma + 1/mb."""
        ma, mb = self.m
        press = (1 + self.restitution) if factor is None else factor(self.restitution)
        impulse = press * self.closing / (1 / ma + 1 / mb if give is None else give(ma, mb))
        return self.v0[0] - impulse / ma, self.v0[1] + impulse / mb

    def at(self, t, contact=None, after=None, wait=0.0):
        """Positions and velocities at times t, each of shape (n, 2).

        contact, after: another time of contact, other velocities afterwards; wait: pause between, s.
        """
        contact = self.contact if contact is None else contact
        t = np.asarray(t, dtype=float)[:, None]
        x0, v0 = np.array(self.x0), np.array(self.v0)
        if not contact < math.inf:
            return x0 + v0 * t, np.broadcast_to(v0, (len(t), 2))
        v1 = np.array(self.after() if after is None else after)
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

    def contacts(self, t_end, slowest):
        """Times (s) of the contacts up to t_end and speeds (m/s) upwards after each; below "
        "``slowest`` none."""
        up = math.sqrt(self.v0**2 + 2 * self.g * (self.z0 - self.radius))
        t, speeds, times = (self.v0 + up) / self.g, [], []
        while t <= t_end:
            up *= self.restitution
            times.append(t)
            if up <= slowest:
                speeds.append(0.0)
                break
            speeds.append(up)
            t += 2 * up / self.g
        return np.array(times), np.array(speeds)

    def at(self, t, slowest):
        """Heights and velocities at times t, each of shape (n,)."""
        t = np.asarray(t, dtype=float)
        times, speeds = self.contacts(float(t[-1]) + 1.0, slowest)
        last = np.searchsorted(times, t, side="left") - 1
        start = np.where(last >= 0, times[last], 0.0)
        up = np.where(last >= 0, speeds[last], self.v0)
        rests = (last >= 0) & (speeds[last] == 0.0)
        s = t - start
        z = np.where(last >= 0, self.radius, self.z0) + np.where(rests, 0.0, up * s - self.g * s * s / 2)
        return z, np.where(rests, 0.0, up - self.g * s)

    def settling(self, t_end, h):
        """From when on the ball may rest, and from when on it must: (s, s).

        Whether the speed before or after a contact is compared with g h decides between two neighbouring
        contacts; both readings are right.
        """
        slowest = self.g * h
        times, speeds = self.contacts(t_end, slowest * (1 - 1e-6))
        slow = speeds <= slowest * (1 + 1e-6)
        if not slow.any():
            return math.inf, math.inf
        # The last hop starts at g h at most, so it is over after two steps.
        must = times[-1] + 2 * h * (1 + 1e-6) if speeds[-1] == 0.0 else math.inf
        return float(times[slow][0]), float(must)

    def args(self, t_end, h):
        """What ``simulate_drop`` is called with."""
        return self.z0, self.v0, self.radius, self.restitution, self.g, t_end, h

    def shown(self, t_end, h):
        """The same as a finding shows it."""
        names = ("z0", "v0", "radius", "restitution", "g", "t_end", "h")
        return dict(zip(names, self.args(t_end, h), strict=True))

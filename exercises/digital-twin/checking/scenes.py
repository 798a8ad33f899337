"""The worlds that the checks and the report of ``digital-twin`` put a twin into.

A cart that rolls (position x, speed v) obeys dx/dt = v, dv/dt = drive - friction * v. Its friction may
jump; nobody tells the twin. Positions are measured with noise, and some measurements arrive late.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

KEYS = ("t", "position", "speed", "friction", "drive", "sigma", "memory")
#: What checks look at along a run; of the other keys only the last twin's cross, for they can be large.
SEEN = KEYS[:4]
#: Std of a measured position, m.
SIGMA = 0.02


@dataclass
class Cart:
    """The real one.

    Attributes:
        frictions: (from this time on, friction), in order of time; s and 1/s.
    """

    frictions: tuple[tuple[float, float], ...]
    x: float = 0.0
    v: float = 0.0
    t: float = 0.0

    def roll(self, drive, until):
        """Go on to time ``until`` with a constant drive; exact, jumps of the friction included."""
        while self.t < until - 1e-12:
            b = [value for start, value in self.frictions if start <= self.t + 1e-12][-1]
            stop = min([until] + [start for start, _ in self.frictions if start > self.t + 1e-12])
            fade = math.exp(-b * (stop - self.t))
            reach = (1 - fade) / b
            self.x += self.v * reach + drive * (stop - self.t - reach) / b
            self.v = self.v * fade + drive * reach
            self.t = stop


@dataclass(frozen=True)
class Run:
    """What was measured of a cart, in the order in which it arrived.

    Attributes:
        calls: the measurements as arguments (z, t_measured) of ``sync``.
        truth: t (s), x (m) and v (m/s) at the time of the twin after each, shape (n, 3).
        late: which of them arrived after a newer one, shape (n,).
        errors: how far each was off when it was taken, m, shape (n,).
        drives: what drove the cart from the time on at which the twin is before each, m/s², shape (n,).
    """

    calls: list[tuple[float, float]]
    truth: np.ndarray
    late: np.ndarray
    errors: np.ndarray
    drives: np.ndarray


def moments(rng, seconds, start=0.0):
    """Times of measurements about every 0.1 s until ``start + seconds``, never evenly spaced, s."""
    times = start + np.cumsum(rng.uniform(0.05, 0.15, math.ceil(seconds / 0.05)))
    return times[times < start + seconds]


def measured(cart, drive, times, rng, *, late=0.0, delay=(0.15, 0.45), sigma=SIGMA):
    """Roll the cart through ``times`` and measure at each.

    drive: one for all the way, or that up to each of the times, m/s²; where another begins, the measurement
        before it is not late, so that the twin is there in time
    late: share of the measurements that arrive later than they were taken, by ``delay`` (low, high) s.

    Returns:
        A ``Run``.
    """
    rows, arrivals = [], []
    drives = np.broadcast_to(drive, len(times)).astype(float)
    last = np.append(np.diff(drives) != 0.0, False)
    for t, u, before_another in zip(times, drives, last, strict=True):
        cart.roll(u, t)
        rows.append((t, cart.x, cart.v))
        lateness = rng.uniform(*delay) if rng.uniform() < late else 0.0
        arrivals.append(t + (0.0 if before_another else lateness))
    order = np.argsort(arrivals, kind="stable")
    errors = sigma * rng.standard_normal(len(rows))
    calls = [(float(rows[i][1] + errors[i]), float(rows[i][0])) for i in order]
    newest = np.maximum.accumulate(order)  # the twin is at the latest time it has heard of
    acting = np.append(drives, drives[-1:])[np.append(0, newest[:-1] + 1)]
    return Run(calls, np.array(rows)[newest], order < newest, errors[order], acting)


def new_twin(friction, drive, *, speed=0.0, position=0.0, t=0.0, sigma=SIGMA):
    """A twin that has not been synchronised yet."""
    values = (t, position, speed, friction, drive, sigma, {})
    return dict(zip(KEYS, values, strict=True))


def recording(rng, n, dt, noise_density, bias_random_walk, bias0):
    """What a gyroscope at rest shows, shape (n,), rad/s."""
    steps = bias_random_walk * math.sqrt(dt) * rng.standard_normal(n - 1)
    bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
    return bias + noise_density / math.sqrt(dt) * rng.standard_normal(n)


#: A room of 6 m by 4 m with a door in its right wall, as end points of walls.
ROOM = np.array(
    [
        [[0.0, 0.0], [6.0, 0.0]],
        [[6.0, 0.0], [6.0, 1.5]],
        [[6.0, 2.5], [6.0, 4.0]],
        [[6.0, 4.0], [0.0, 4.0]],
        [[0.0, 4.0], [0.0, 0.0]],
    ]
)


def room_ranges(pose, angles, r_max):
    """Distances in ``ROOM`` from inside, by where a beam leaves the rectangle; the door opens on nothing."""
    x, y, heading = pose
    beam = heading + np.asarray(angles)
    with np.errstate(divide="ignore"):
        across = np.abs(np.where(np.cos(beam) > 0, 6.0 - x, x) / np.cos(beam))
        up = np.abs(np.where(np.sin(beam) > 0, 4.0 - y, y) / np.sin(beam))
    leaves = np.minimum(across, up)
    height = y + across * np.sin(beam)
    door = (across < up) & (np.cos(beam) > 0) & (height > 1.5) & (height < 2.5)
    return np.where(door | (leaves > r_max), r_max, leaves)

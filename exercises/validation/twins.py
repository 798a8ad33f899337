"""Carts that were driven and recorded, and simulations of them that are right or wrong on purpose.

A cart of mass m (kg) rolls with friction b (N s/m) under a force made of a few sines, so its speed is known
in closed form at any time, and a simulation that is late by any amount is exact, too. The checks and the
report make their data with this; each has its own seed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

MASS, FRICTION = 1.5, 0.6


@dataclass(frozen=True)
class Drive:
    """A force of several sines: amplitude (N), angular frequency (rad/s) and phase (rad) of each."""

    amplitude: np.ndarray
    omega: np.ndarray
    phase: np.ndarray

    def speed(self, t, mass=MASS, friction=FRICTION):
        """Speed of the cart at times t (s), m/s, long after the start."""
        answer = self.amplitude / (friction + 1j * self.omega * mass)
        angle = np.multiply.outer(np.asarray(t), self.omega) + self.phase
        return np.sum(np.abs(answer) * np.sin(angle + np.angle(answer)), axis=-1)


@dataclass(frozen=True)
class Recording:
    """One run: its id, times (s), force, measured speed (m/s) and the std of the measurement's noise."""

    id: str
    t: np.ndarray
    drive: Drive
    y: np.ndarray
    noise: float


def record(rng, run_id, seconds, dt, noise):
    """Drive the real cart once, and measure."""
    omega = 2 * np.pi * rng.uniform([0.4, 0.8, 1.2], [0.7, 1.1, 1.6])
    # Each sine moves the cart by about as much, whatever its frequency.
    drive = Drive(MASS * omega * rng.uniform(0.4, 0.7, 3), omega, rng.uniform(0, 2 * np.pi, 3))
    t = dt * np.arange(round(seconds / dt) + 1)
    return Recording(run_id, t, drive, drive.speed(t) + noise * rng.standard_normal(len(t)), noise)


def simulated(recordings, *, mass=MASS, late=0.0, offset=0.0, sigma_factor=1.0, calibrated_on=()):
    """What a simulation says to the same forces.

    mass: the mass it believes in, kg
    late: how much it lags behind, s
    offset: what it adds to every speed, m/s
    sigma_factor: the sigma it claims, in units of the real noise
    """
    runs = [
        {
            "id": run.id,
            "t": run.t.copy(),
            "y": run.drive.speed(run.t - late, mass) + offset,
            "sigma": np.full(len(run.t), sigma_factor * run.noise),
        }
        for run in recordings
    ]
    return {"calibrated_on": list(calibrated_on), "runs": runs}


def measured(recordings):
    """What the real cart did, in the same form."""
    return {"runs": [{"id": run.id, "t": run.t.copy(), "y": run.y.copy()} for run in recordings]}

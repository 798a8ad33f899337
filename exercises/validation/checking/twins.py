"""Carts that were driven and recorded, and simulations of them that are right or wrong on purpose.

A cart of mass m (kg) rolls with friction b (N s/m) under a steady force and a few sines, so its speed is
known in closed form at any time, and a simulation that is late by any amount is exact, too. The checks and
the report make their data with this; each has its own seed.
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

    def moved(self, t, shifts, mass=MASS, friction=FRICTION):
        """Speed at times t (s) moved by each of the shifts (s): m/s, a row for each shift."""
        answer = self.amplitude / (friction + 1j * self.omega * mass) * np.exp(1j * self.phase)
        return _waves(np.exp(1j * np.multiply.outer(shifts, self.omega)) * answer, self.omega, t)


@dataclass(frozen=True)
class Wave:
    """A speed that swings about a middle once a second, in the place of a drive (m/s)."""

    middle: float
    size: float

    def speed(self, t, mass=MASS):
        """Speed at times t (s), m/s."""
        return self.middle + self.size * np.sin(2 * np.pi * np.asarray(t))

    def moved(self, t, shifts, mass=MASS):
        """Speed at times t (s) moved by each of the shifts (s): m/s, a row for each shift."""
        turned = self.size * np.exp(2j * np.pi * np.asarray(shifts))[:, None]
        return self.middle + _waves(turned, np.array([2 * np.pi]), t)


def _waves(phasors, omega, t):
    """The imaginary part of ``phasors @ exp(1j omega t)``: a row of sums of sines for each row of phasors.

    A few hundred rows cost a product of real matrices and not a sine for every number.
    """
    turns = np.exp(1j * np.multiply.outer(omega, t))
    return np.hstack([phasors.real, phasors.imag]) @ np.vstack([turns.imag, turns.real])


@dataclass(frozen=True)
class Recording:
    """One run: its id, times (s), force, measured speed (m/s) and the std of the measurement's noise."""

    id: str
    t: np.ndarray
    drive: Drive
    y: np.ndarray
    noise: float


def record(rng, run_id, seconds, dt, noise, *, swing=1.0, begin=0.0):
    """Drive the real cart once, and measure.

    Args:
        swing: how far it is driven, as a multiple of the usual.
        begin: the first time, s.
    """
    omega = 2 * np.pi * rng.uniform([0.4, 0.8, 1.2], [0.7, 1.1, 1.6])
    # Each sine moves the cart by about as much, whatever its frequency; the force of no frequency keeps it
    # going one way, so that no recording averages zero.
    amplitude = swing * MASS * omega * rng.uniform(0.4, 0.7, 3)
    steady = FRICTION * rng.choice([-1.0, 1.0]) * rng.uniform(0.6, 1.4)
    phase = rng.uniform(0, 2 * np.pi, 3)
    drive = Drive(np.append(amplitude, steady), np.append(omega, 0.0), np.append(phase, np.pi / 2))
    t = begin + dt * np.arange(round(seconds / dt) + 1)
    return Recording(run_id, t, drive, drive.speed(t) + noise * rng.standard_normal(len(t)), noise)


def simulated(recordings, *, mass=MASS, late=0.0, offset=0.0, sigma_factor=1.0, calibrated_on=()):
    """What a simulation says to the same forces.

    mass: the mass it believes in, kg
    late: how much it lags behind, s; one number, or one for each run
    offset: what it adds to every speed, m/s; one number, or one for each run
    sigma_factor: the sigma it claims, in units of the real noise; one number, or one for each run
    """
    late, offset, factor = (np.broadcast_to(x, len(recordings)) for x in (late, offset, sigma_factor))
    runs = [
        {
            "id": run.id,
            "t": run.t.copy(),
            "y": run.drive.speed(run.t - late[i], mass) + offset[i],
            "sigma": np.full(len(run.t), factor[i] * run.noise),
        }
        for i, run in enumerate(recordings)
    ]
    return {"calibrated_on": list(calibrated_on), "runs": runs}


def measured(recordings):
    """What the real cart did, in the same form."""
    return {"runs": [{"id": run.id, "t": run.t.copy(), "y": run.y.copy()} for run in recordings]}

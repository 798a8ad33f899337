"""Solutions to compare with: closed forms where they exist, and a numerical reference for everything else.

``reference`` is accurate to about twelve digits on the smooth problems of this course, and the tests compare
it with the closed forms.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from course.physics.state import Array
from course.physics.systems import DampedOscillator, ForcedOscillator, Oscillator, System

_COLUMNS = 10  # extrapolation columns; past ten, round-off wins
_MAX_HALVINGS = 8


def oscillator(system: Oscillator, q0: ArrayLike, v0: ArrayLike, t: float) -> tuple[Array, Array]:
    """Position and velocity of an undamped spring after t (s); shapes (d,)."""
    q = np.asarray(q0, dtype=float)
    v = np.asarray(v0, dtype=float)
    w = system.omega
    c, s = math.cos(w * t), math.sin(w * t)
    return c * q + (s / w) * v, c * v - (w * s) * q


def damped_oscillator(
    system: DampedOscillator, q0: ArrayLike, v0: ArrayLike, t: float
) -> tuple[Array, Array]:
    """Position and velocity of an underdamped spring after t (s); shapes (d,).

    Raises:
        ValueError: the damping is critical or above (rate >= 2 omega).
    """
    half = 0.5 * system.rate
    if not half < system.omega:
        raise ValueError("This form is for rate < 2 omega only.")
    w = math.sqrt(system.omega**2 - half**2)
    q = np.asarray(q0, dtype=float)
    b = (np.asarray(v0, dtype=float) + half * q) / w
    c, s, fade = math.cos(w * t), math.sin(w * t), math.exp(-half * t)
    position = fade * (c * q + s * b)
    return position, fade * w * (c * b - s * q) - half * position


def forced_oscillator(
    system: ForcedOscillator, q0: ArrayLike, v0: ArrayLike, t: float, t0: float = 0.0
) -> tuple[Array, Array]:
    """Position and velocity of a driven spring at time t, from (q0, v0) at time t0 (s); shapes (d,).

    Raises:
        ValueError: the drive is at resonance, where this form divides by zero.
    """
    gap = system.omega**2 - system.drive**2
    if gap == 0.0:
        raise ValueError("This form is for a drive off resonance only.")
    far = system.amplitude / gap
    drive = system.drive
    q = np.asarray(q0, dtype=float) - far * math.cos(drive * t0)
    v = np.asarray(v0, dtype=float) + far * drive * math.sin(drive * t0)
    q, v = oscillator(Oscillator(system.omega), q, v, t - t0)  # what is left of the start
    return q + far * math.cos(drive * t), v - far * drive * math.sin(drive * t)


def solution(
    system: System, q0: ArrayLike, v0: ArrayLike, times: Sequence[float] | Array, t0: float = 0.0
) -> tuple[Array, Array]:
    """Position and velocity at given times, each (n, d): by the closed form where there is one.

    Arguments and errors are those of ``reference``, which answers for the other systems.
    """
    if isinstance(system, Oscillator):
        rows = [oscillator(system, q0, v0, t - t0) for t in times]
    elif isinstance(system, DampedOscillator) and system.rate < 2 * system.omega:
        rows = [damped_oscillator(system, q0, v0, t - t0) for t in times]
    elif isinstance(system, ForcedOscillator) and system.drive != system.omega:
        rows = [forced_oscillator(system, q0, v0, t, t0) for t in times]
    else:
        return reference(system, q0, v0, times, t0)
    return np.array([q for q, _ in rows]), np.array([v for _, v in rows])


def reference(
    system: System, q0: ArrayLike, v0: ArrayLike, times: Sequence[float] | Array, t0: float = 0.0
) -> tuple[Array, Array]:
    """Position and velocity at given times, to about twelve digits.

    Each interval is integrated by the midpoint rule with 2, 4, 6, ... substeps, extrapolated to step zero; an
    interval that does not converge is halved.

    Args:
        q0, v0: state at t0 (s), shape (d,).
        times: rising times after t0, s; shape (n,).

    Returns:
        q and v, each of shape (n, d).

    Raises:
        ValueError: the times do not rise from t0, or the solution does not converge (a collision, say).

    Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 1993, section II.9 (GBS).
    """
    y = np.array([q0, v0], dtype=float)  # row 0 positions, row 1 velocities

    def slope(t: float, y: Array) -> Array:
        rates = np.empty_like(y)
        rates[0] = y[1]
        rates[1] = system(t, y[0], y[1])
        return rates

    now = t0
    rows = []
    for time in map(float, times):
        if not time >= now:
            raise ValueError("The times of a reference must rise from its start.")
        y = _cross(slope, now, y, time - now, _MAX_HALVINGS)
        rows.append(y)
        now = time
    table = np.array(rows).reshape(len(rows), *y.shape)
    return table[:, 0], table[:, 1]


def _cross(slope, t: float, y: Array, span: float, halvings: int) -> Array:  # type: ignore[no-untyped-def]
    """The solution ``span`` later, by extrapolation; halves the span where that does not converge."""
    row: list[Array] = []
    for k in range(1, _COLUMNS + 1):
        previous, row = row, [_midpoint(slope, t, y, span, 2 * k)]
        for j, older in enumerate(previous):
            # Aitken-Neville: the error is a series in (1/n)², so column j cancels its first j terms.
            row.append(row[j] + (row[j] - older) / ((k / (k - j - 1)) ** 2 - 1.0))
        if k > 2 and np.max(np.abs(row[-1] - row[-2])) <= 1e-13 * (1.0 + np.max(np.abs(row[-1]))):
            return row[-1]
    if halvings == 0:
        raise ValueError("The reference does not converge here: is there a singularity?")
    middle = _cross(slope, t, y, 0.5 * span, halvings - 1)
    return _cross(slope, t + 0.5 * span, middle, 0.5 * span, halvings - 1)


def _midpoint(slope, t: float, y: Array, span: float, n: int) -> Array:  # type: ignore[no-untyped-def]
    """Gragg's smoothed midpoint rule with n substeps (n even)."""
    h = span / n
    before, here = y, y + h * slope(t, y)
    for i in range(1, n):
        before, here = here, before + 2.0 * h * slope(t + i * h, here)
    return np.asarray(0.5 * (here + before + h * slope(t + span, here)))

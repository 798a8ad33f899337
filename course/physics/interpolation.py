"""Values between two samples: cubic Hermite interpolation and the first root of a sampled curve.

A trajectory is known at its samples together with its slopes there, and the cubic through both is exact for
anything that moves with constant acceleration. So events (a landing, an apex) are found far more accurately
than to one step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    Array = NDArray[np.float64]

__all__ = ["falling_root", "first_crossing", "hermite"]

_BISECTIONS = 60  # each halves the bracket; 53 of them exhaust a float


def hermite(s: ArrayLike, y0: Array, y1: Array, d0: Array, d1: Array) -> Array:
    """The cubic with values y0, y1 and slopes d0, d1 at s = 0 and s = 1 (slopes per unit of s)."""
    s = np.asarray(s, dtype=float)
    jump = y1 - y0
    return np.asarray(y0 + s * (d0 + s * ((3 * jump - 2 * d0 - d1) + s * (d0 + d1 - 2 * jump))))


def falling_root(y0: Array, y1: Array, d0: Array, d1: Array) -> Array:
    """Where the cubic falls through 0 before a negative end, as a fraction of the interval.

    Starting at or below 0 and falling counts as 0; starting there and rising, the way up comes first.

    Args:
        y0, y1: values at both ends; any shape.
        d0, d1: slopes there, per interval.

    Returns:
        The fraction in [0, 1]; inf where the end is not negative. Same shape.
    """
    # The top of the curve, if its slope were to change linearly: there the bracket begins.
    fall = np.where(d0 > d1, d0 - d1, 1.0)
    top = np.where((y0 <= 0) & (d0 > 0), np.clip(d0 / fall, 0.0, 1.0), 0.0)
    low, high = top, np.ones_like(top)
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        above = hermite(middle, y0, y1, d0, d1) > 0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    root = np.where((y0 <= 0) & (d0 <= 0), 0.0, high)
    return np.where(y1 < 0, root, np.inf)


def first_crossing(t: ArrayLike, y: ArrayLike, rate: ArrayLike) -> float:
    """The first time at which a sampled curve comes down through 0; NaN if it never does.

    Args:
        t: sample times, shape (n,), s.
        y: values, shape (n,), in any unit.
        rate: slopes dy/dt, shape (n,).
    """
    t, y, rate = (np.asarray(values, dtype=float) for values in (t, y, rate))
    down = np.flatnonzero((y[:-1] > 0) & (y[1:] <= 0))
    if down.size == 0:
        return float("nan")
    i = int(down[0])
    if y[i + 1] == 0.0:
        return float(t[i + 1])
    h = t[i + 1] - t[i]
    return float(t[i] + h * falling_root(y[i], y[i + 1], h * rate[i], h * rate[i + 1]))

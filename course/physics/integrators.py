"""The four classical ways to step a system forward, as objects over a system and a state.

    ============================  =====  ==========  =================  =======================
    method                        order  symplectic  evaluations/step   stable on a spring while
    ============================  =====  ==========  =================  =======================
    ``ExplicitEuler``             1      no          1                  never
    ``SemiImplicitEuler``         1      yes         1                  h omega < 2
    ``VelocityVerlet``            2      yes         2                  h omega < 2
    ``RK4``                       4      no          4                  h omega < 2 sqrt(2)
    ============================  =====  ==========  =================  =======================

Order and symplecticity of the Verlet method hold where the acceleration does not depend on the velocity.

    >>> from course.physics.systems import Oscillator
    >>> start = State.at_rest([1.0])
    >>> path = trajectory(VelocityVerlet(), Oscillator(omega=2.0), start, h=0.01, n=500)
    >>> path.t[-1], path.q.shape
    (5.0, (501, 1))

Source: Hairer, Lubich, Wanner, Acta Numerica 2003 (Verlet); Hairer, Norsett, Wanner, Solving Ordinary
Differential Equations I, 1993, section II.1 (Runge-Kutta).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from course.physics.state import Array
from course.physics.systems import Acceleration


@dataclass(frozen=True, slots=True)
class State:
    """Where a system is: time t (s), position q (m or rad) and velocity v, each of shape (d,)."""

    t: float
    q: Array
    v: Array

    @classmethod
    def of(cls, q: ArrayLike, v: ArrayLike, t: float = 0.0) -> Self:
        """A state from anything array-like, copied to float."""
        return cls(t, np.array(q, dtype=float), np.array(v, dtype=float))

    @classmethod
    def at_rest(cls, q: ArrayLike, t: float = 0.0) -> Self:
        """A state with no velocity."""
        return cls.of(q, np.zeros(np.shape(q)), t)

    def shifted(self, h: float, dq: Array, dv: Array) -> State:
        """The state h (s) later, displaced by dq and dv."""
        return State(self.t + h, self.q + dq, self.v + dv)


class Stepper(Protocol):
    """A method that advances a state by one step; new states never share memory with old ones."""

    order: ClassVar[int]

    def advance(self, system: Acceleration, state: State, h: float) -> State:
        """The state h (s) after ``state``."""
        ...


@dataclass(frozen=True, slots=True)
class ExplicitEuler:
    """Order 1, not symplectic: follow the tangent. On a spring the energy grows by 1 + (h omega)² a step."""

    order: ClassVar[int] = 1

    def advance(self, system: Acceleration, state: State, h: float) -> State:
        return state.shifted(h, h * state.v, h * system(state.t, state.q, state.v))


@dataclass(frozen=True, slots=True)
class SemiImplicitEuler:
    """Order 1, symplectic: update one half of the state, then the other with the updated half.

    Attributes:
        position_first: drift then kick, with the acceleration at the new position and time, instead of
            kick then drift. Each is the other one run backwards.
    """

    position_first: bool = False

    order: ClassVar[int] = 1

    def advance(self, system: Acceleration, state: State, h: float) -> State:
        if self.position_first:
            q = state.q + h * state.v
            return State(state.t + h, q, state.v + h * system(state.t + h, q, state.v))
        v = state.v + h * system(state.t, state.q, state.v)
        return State(state.t + h, state.q + h * v, v)


@dataclass(frozen=True, slots=True)
class VelocityVerlet:
    """Order 2, symplectic and reversible: half a kick, a drift, half a kick (Störmer's method, leapfrog).

    Attributes:
        drift_first: half a drift, a kick, half a drift instead; one evaluation, taken at mid-step.
    """

    drift_first: bool = False

    order: ClassVar[int] = 2

    def advance(self, system: Acceleration, state: State, h: float) -> State:
        half = 0.5 * h
        if self.drift_first:
            q_middle = state.q + half * state.v
            v = state.v + h * system(state.t + half, q_middle, state.v)
            return State(state.t + h, q_middle + half * v, v)
        v_middle = state.v + half * system(state.t, state.q, state.v)
        q = state.q + h * v_middle
        return State(state.t + h, q, v_middle + half * system(state.t + h, q, v_middle))


@dataclass(frozen=True, slots=True)
class RK4:
    """Order 4, not symplectic: four slopes a step, weighted as Simpson's rule weights them."""

    order: ClassVar[int] = 4

    def advance(self, system: Acceleration, state: State, h: float) -> State:
        def slopes(stage: State) -> tuple[Array, Array]:
            return stage.v, system(stage.t, stage.q, stage.v)

        half = 0.5 * h
        q1, v1 = slopes(state)
        q2, v2 = slopes(state.shifted(half, half * q1, half * v1))
        q3, v3 = slopes(state.shifted(half, half * q2, half * v2))
        q4, v4 = slopes(state.shifted(h, h * q3, h * v3))
        sixth = h / 6.0
        return state.shifted(h, sixth * (q1 + 2 * q2 + 2 * q3 + q4), sixth * (v1 + 2 * v2 + 2 * v3 + v4))


#: The methods under the names that the command line and the lessons use.
STEPPERS: dict[str, Stepper] = {
    "explicit_euler": ExplicitEuler(),
    "semi_implicit_euler": SemiImplicitEuler(),
    "velocity_verlet": VelocityVerlet(),
    "rk4": RK4(),
}


class Trajectory(NamedTuple):
    """Samples at equal times: t of shape (n + 1,) in s, q and v of shape (n + 1, *shape of the state)."""

    t: Array
    q: Array
    v: Array


def trajectory(stepper: Stepper, system: Acceleration, start: State, h: float, n: int) -> Trajectory:
    """Take n steps of h (s) and keep every state, the first included.

    Times are start.t + i h, not a running sum, so they do not drift.

    Args:
        h: negative to go back in time.

    Raises:
        ValueError: h is 0 or not finite, n is not a whole number of steps, the start is not finite, or the
            system's acceleration there is not a number. A method that blows up later is not stopped.
    """
    if not (math.isfinite(h) and h != 0):
        raise ValueError(f"A step must be a finite number of seconds and not 0; this one is {h}.")
    if not isinstance(n, (int, np.integer)) or isinstance(n, bool) or n < 0:
        raise ValueError(f"The number of steps must be a whole number, 0 or more; this one is {n!r}.")
    for name, value in (("t", start.t), ("q", start.q), ("v", start.v)):
        if not np.all(np.isfinite(value)):
            raise ValueError(f"The start must be finite numbers; its {name} is {np.asarray(value).tolist()}.")
    t: Array = start.t + h * np.arange(n + 1, dtype=np.float64)
    q = np.empty((n + 1, *start.q.shape))
    v = np.empty((n + 1, *start.q.shape))
    state = start
    q[0], v[0] = state.q, state.v
    for i in range(n):
        state = stepper.advance(system, State(float(t[i]), state.q, state.v), h)
        q[i + 1], v[i + 1] = state.q, state.v
        if i == 0 and (np.isnan(state.q).any() or np.isnan(state.v).any()):
            name = type(system).__name__
            raise ValueError(
                f"At the start the acceleration of {name} is not a number; check what it is given."
            )
    return Trajectory(t, q, v)


# ---
# Values between two samples. A trajectory is known at its samples together with its slopes there, and the
# cubic through both is exact for anything that moves with constant acceleration. So events (a landing, an
# apex) are found far more accurately than to one step.

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

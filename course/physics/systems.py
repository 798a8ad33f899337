"""Right-hand sides: the accelerations of the systems this course integrates.

A system is a frozen object with plain numbers in it. Called as ``system(t, q, v)`` it returns the
acceleration there, as a new array; ``system.params()`` gives the numbers back, and
``SYSTEMS[name](**params)`` rebuilds it, so a system can be sent to another process as a name and numbers.

Units are SI and angles radians. ``q`` and ``v`` have shape (d,); the systems of one degree of freedom
apply to each component on its own.

This file is self-contained, because it is copied into the student's process. It imports only the standard
library and numpy, and has neither an integrator nor a solution, which would give away answers.
"""

# ruff: noqa: ARG002 - every right-hand side takes (t, q, v); most need only some of them

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, overload

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]


class Acceleration(Protocol):
    """An object that returns an acceleration: any method can step it forward."""

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        """Acceleration at time t (s), position q (m or rad), velocity v; shape (d,)."""
        ...


class System(Acceleration, Protocol):
    """One that also knows its own parameters."""

    def params(self) -> dict[str, Any]:
        """The numbers that rebuild this system."""
        ...


class _Plain:
    """The base of every system: its parameters are its fields, which are plain finite numbers."""

    __slots__ = ()

    def params(self) -> dict[str, Any]:
        """Parameters as plain numbers and lists, by name."""
        return {name: getattr(self, name) for name in self.__match_args__}  # type: ignore[attr-defined]

    def __post_init__(self) -> None:
        for name, value in self.params().items():
            if not math.isfinite(value):
                raise ValueError(f"{type(self).__name__}.{name} must be a finite number, not {value!r}.")


@dataclass(frozen=True, slots=True)
class FreeFall(_Plain):
    """Constant gravity along the last axis, which points up. g in m/s²."""

    g: float = 9.81

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        a = np.zeros(np.shape(q))
        a[-1] = -self.g
        return a


@dataclass(frozen=True, slots=True)
class Oscillator(_Plain):
    """Undamped spring: a = -omega² q. omega in rad/s."""

    omega: float

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        return -(self.omega**2) * np.asarray(q, dtype=float)


@dataclass(frozen=True, slots=True)
class DampedOscillator(_Plain):
    """Spring and viscous damper: a = -omega² q - rate v. omega in rad/s, rate in 1/s."""

    omega: float
    rate: float

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        return -(self.omega**2) * np.asarray(q, dtype=float) - self.rate * np.asarray(v, dtype=float)


@dataclass(frozen=True, slots=True)
class ForcedOscillator(_Plain):
    """Spring with a drive that depends on time: a = -omega² q + amplitude cos(drive t).

    omega and drive in rad/s, amplitude in m/s². Its acceleration depends on t, so it shows wrong stage times;
    no autonomous problem does.
    """

    omega: float
    amplitude: float
    drive: float

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        return -(self.omega**2) * np.asarray(q, dtype=float) + self.amplitude * math.cos(self.drive * t)


@dataclass(frozen=True, slots=True)
class Pendulum(_Plain):
    """A point mass on a rigid rod: a = -(g/length) sin q, q from the lowest point. g in m/s², length in m."""

    g: float = 9.81
    length: float = 1.0

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        a: Array = -(self.g / self.length) * np.sin(np.asarray(q, dtype=float))
        return a


@dataclass(frozen=True, slots=True)
class DrivenPendulum(_Plain):
    """Pendulum with damping and a drive: a = -stiffness sin q - rate v + amplitude cos(drive t).

    stiffness in 1/s², rate in 1/s, amplitude in rad/s², drive in rad/s. Non-linear, dissipative and driven
    at once, so that every argument of an acceleration matters.
    """

    stiffness: float
    rate: float
    amplitude: float
    drive: float

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        q = np.asarray(q, dtype=float)
        push = self.amplitude * math.cos(self.drive * t)
        a: Array = -self.stiffness * np.sin(q) - self.rate * np.asarray(v, dtype=float) + push
        return a


@dataclass(frozen=True, slots=True)
class VanDerPol(_Plain):
    """Self-excited oscillator: a = mu (1 - q²) v - omega² q. mu in 1/s, omega in rad/s, q without unit."""

    mu: float
    omega: float = 1.0

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        q = np.asarray(q, dtype=float)
        a: Array = self.mu * (1.0 - q * q) * np.asarray(v, dtype=float) - self.omega**2 * q
        return a


@dataclass(frozen=True, slots=True)
class Kepler(_Plain):
    """A light body around a fixed centre at the origin: a = -mu q / |q|³. mu in m³/s²."""

    mu: float = 1.0

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        q = np.asarray(q, dtype=float)
        distance_sq = float(q @ q)
        return (-self.mu / (distance_sq * math.sqrt(distance_sq))) * q


@dataclass(frozen=True, slots=True)
class LinearStep(_Plain):
    """A made-up one-step map with a chosen stability limit; not an integrator of anything.

    On an oscillator, with p = v/omega and z = h omega, one step is::

        q_next = qq(z) q + qp(z) p          p_next = pq(z) q + pp(z) p

    where the four entries are polynomials in z, given by their coefficients, lowest power first. ``clock``
    (m/s²) adds ``clock h t`` to q_next, so that a caller who passes the wrong time is seen. It is called as
    the exercises' steps are, ``step(accel, t, q, v, h)``, and learns omega from the acceleration at a unit
    displacement.
    """

    qq: Sequence[float]
    qp: Sequence[float]
    pq: Sequence[float]
    pp: Sequence[float]
    clock: float = 0.0

    def __post_init__(self) -> None:
        for name in ("qq", "qp", "pq", "pp"):
            coefficients = tuple(float(c) for c in getattr(self, name))
            if not coefficients or not all(map(math.isfinite, coefficients)):
                raise ValueError(f"LinearStep.{name} must be finite coefficients, lowest power first.")
            object.__setattr__(self, name, coefficients)

    def params(self) -> dict[str, Any]:
        """Coefficients as lists, and the clock term."""
        entries = {name: list(getattr(self, name)) for name in ("qq", "qp", "pq", "pp")}
        return {**entries, "clock": self.clock}

    def matrix(self, z: ArrayLike) -> Array:
        """The map on (q, v/omega) at z = h omega; shape (2, 2), or (..., 2, 2) for an array of z."""
        z = np.asarray(z, dtype=float)
        entries = [np.polyval(c[::-1], z) for c in (self.qq, self.qp, self.pq, self.pp)]
        return np.stack(np.broadcast_arrays(*entries), axis=-1).reshape(*z.shape, 2, 2)

    def __call__(
        self,
        accel: Callable[[float, Array, Array], ArrayLike],
        t: float,
        q: ArrayLike,
        v: ArrayLike,
        h: float,
    ) -> tuple[Array, Array]:
        """One step of size h (s) from (q, v) at time t.

        Raises:
            TypeError: q or v is a single number; a step takes arrays.
            ValueError: accel is not that of an oscillator: it does not pull a unit displacement back.
        """
        q, p = np.asarray(q, dtype=float), np.asarray(v, dtype=float)
        if not (q.ndim and p.ndim):
            raise TypeError("This step takes arrays: q and v have the shape (d,), also for d = 1.")
        at_one = np.zeros(q.shape)
        at_one.fill(1.0)
        pull = -float(np.asarray(accel(t, at_one, np.zeros(q.shape))).item(0))
        if not pull > 0.0:
            raise ValueError("This step needs accel = -omega**2 * q; the accel it got does not pull back.")
        omega = math.sqrt(pull)
        z = h * omega
        p = p / omega
        q_next = _polynomial(self.qq, z) * q + _polynomial(self.qp, z) * p + self.clock * h * t
        p_next = _polynomial(self.pq, z) * q + _polynomial(self.pp, z) * p
        return q_next, omega * p_next


@dataclass(frozen=True, slots=True)
class AveragePolynomial(_Plain):
    """A made-up statistic: the average of a polynomial of the samples, e.g. (0, 1) the mean.

    It is called as statistics are, ``statistic(e)``, with one-dimensional samples. It is here so that
    thousands of resamples need no messages. Coefficients, lowest power first.
    """

    coefficients: Sequence[float]

    def __post_init__(self) -> None:
        values = tuple(float(c) for c in self.coefficients)
        if not values or not all(map(math.isfinite, values)):
            raise ValueError("AveragePolynomial.coefficients must be finite numbers, lowest power first.")
        object.__setattr__(self, "coefficients", values)

    def params(self) -> dict[str, Any]:
        """The coefficients as a list."""
        return {"coefficients": list(self.coefficients)}

    def __call__(self, e: ArrayLike) -> float:
        """The statistic of the samples, shape (n,).

        Raises:
            ValueError: the samples are none, or not one-dimensional.
        """
        e = np.asarray(e, dtype=float)
        if e.ndim != 1 or not e.size:
            raise ValueError(f"A statistic takes samples of shape (n,), n > 0; these have shape {e.shape}.")
        constant, *rest = self.coefficients
        if not rest:
            return constant
        return constant + float(np.add.reduce(_polynomial(rest, e) * e) / e.size)


@overload
def _polynomial(coefficients: Sequence[float], z: float) -> float: ...
@overload
def _polynomial(coefficients: Sequence[float], z: Array) -> Array: ...
def _polynomial(coefficients: Sequence[float], z: Any) -> Any:
    value: Any = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        value = value * z + coefficient
    return value


#: What may cross to another process, by name.
SYSTEMS: dict[str, type[Any]] = {
    cls.__name__: cls
    for cls in (
        FreeFall,
        Oscillator,
        DampedOscillator,
        ForcedOscillator,
        Pendulum,
        DrivenPendulum,
        VanDerPol,
        Kepler,
        LinearStep,
        AveragePolynomial,
    )
}

"""Conserved quantities of a trajectory, and how to measure how well a method conserves them.

Energies are per unit mass (J/kg) and take a whole trajectory at once: q and v of shape (..., d) give
energies of shape (...).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from course.physics.state import Array
from course.physics.systems import FreeFall, Kepler, Oscillator, Pendulum, System


def energy(system: System, q: ArrayLike, v: ArrayLike) -> Array:
    """Kinetic and potential energy per unit mass.

    Args:
        system: a conservative system.
        q, v: positions (m or rad) and velocities, shape (..., d). A pendulum's are angles; its energy is
            divided by length² as well, which leaves (rad/s)².

    Returns:
        Shape (...), J/kg.

    Raises:
        TypeError: the system has no conserved energy.
    """
    q = np.asarray(q, dtype=float)
    v = np.asarray(v, dtype=float)
    kinetic = 0.5 * np.sum(v * v, axis=-1)
    if isinstance(system, FreeFall):
        return np.asarray(kinetic + system.g * q[..., -1])
    if isinstance(system, Oscillator):
        return np.asarray(kinetic + 0.5 * system.omega**2 * np.sum(q * q, axis=-1))
    if isinstance(system, Pendulum):
        return np.asarray(kinetic + (system.g / system.length) * np.sum(1.0 - np.cos(q), axis=-1))
    if isinstance(system, Kepler):
        return np.asarray(kinetic - system.mu / np.linalg.norm(q, axis=-1))
    raise TypeError(f"{type(system).__name__} is driven or damped: it has no conserved energy.")


def angular_momentum(q: ArrayLike, v: ArrayLike) -> Array:
    """Angular momentum per unit mass about the origin, m²/s; q and v of shape (..., 2) give shape (...)."""
    q = np.asarray(q, dtype=float)
    v = np.asarray(v, dtype=float)
    return np.asarray(q[..., 0] * v[..., 1] - q[..., 1] * v[..., 0])


def relative_change(values: ArrayLike) -> Array:
    """``(x_i - x_0) / |x_0|`` along the first axis."""
    values = np.asarray(values, dtype=float)
    return np.asarray((values - values[0]) / np.abs(values[0]))


def convergence_order(hs: ArrayLike, errors: ArrayLike) -> float:
    """The power of the step that the errors shrink with: least-squares slope of log error over log step.

    Args:
        hs: at least two different positive steps, s.
        errors: one positive error per step, in any one unit.

    Raises:
        ValueError: fewer than two steps, or anything not positive.
    """
    hs = np.asarray(hs, dtype=float)
    errors = np.asarray(errors, dtype=float)
    if hs.ndim != 1 or hs.shape != errors.shape or hs.size < 2:
        raise ValueError("An order needs two or more steps and one error for each.")
    if not (np.all(hs > 0) and np.all(errors > 0)):
        raise ValueError("Steps and errors must be positive: they are compared by their logarithms.")
    x = np.log(hs)
    x = x - x.mean()
    return float(x @ np.log(errors) / (x @ x))


def jacobian(flow: Callable[[Array], Array], y: ArrayLike, delta: float = 1e-5) -> Array:
    """Derivative of a map R^n -> R^n at y, by central differences; shape (n, n).

    Args:
        flow: the map, for instance one step on (q, v) put end to end.
        delta: displacement each way. The error is about delta² times the map's third derivative, plus
            round-off over delta: near 1e-10 at 1e-5 for maps of size one.
    """
    return jacobian_of_many(lambda states: np.stack([flow(state) for state in states]), y, delta)


def jacobian_of_many(flows: Callable[[Array], Array], y: ArrayLike, delta: float = 1e-5) -> Array:
    """``jacobian`` of a map that takes all its 2n displaced states at once, shape (2n, n), row by row."""
    y = np.asarray(y, dtype=float)
    shift = delta * np.eye(y.size)
    forth, back = y + shift, y - shift
    moved = flows(np.concatenate([forth, back]))
    widths = (forth - back).diagonal()[:, None]
    derivative: Array = ((moved[: y.size] - moved[y.size :]) / widths).T
    return derivative


def symplecticity_defect(derivative: ArrayLike) -> float:
    """``max |J^T Omega J - Omega|`` of the derivative of a map on (q, v); 0 if the map is symplectic.

    In one degree of freedom this is |det J - 1|; in more, it is a stronger condition than a preserved volume.

    Args:
        derivative: shape (2d, 2d), positions before velocities.

    Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, 2006, section VI.2.
    """
    j = np.asarray(derivative, dtype=float)
    d = j.shape[0] // 2
    omega = np.block([[np.zeros((d, d)), np.eye(d)], [-np.eye(d), np.zeros((d, d))]])
    return float(np.max(np.abs(j.T @ omega @ j - omega)))


def spectral_radius(matrix: ArrayLike) -> float:
    """Largest modulus of the eigenvalues of a square matrix: powers of it stay bounded below 1."""
    return float(np.max(np.abs(np.linalg.eigvals(np.asarray(matrix, dtype=float)))))

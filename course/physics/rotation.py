"""Quaternions, and three ways to step a rotating body forward.

A unit quaternion [w, x, y, z] = [cos(a/2), sin(a/2) n] turns by the angle a about the unit vector n. Here it
takes vectors from the body's axes to the world's. Products of unit quaternions are unit quaternions, sums are
not: *adding* ``h dq/dt`` leaves the sphere, *multiplying* by a small rotation stays on it.

A free body obeys Euler's equations ``I dw/dt = torque - w x (I w)`` in its own axes. The second term, the
gyroscopic one, is why a body spun about its middle axis flips over and over (Dzhanibekov's wing nut).

Source: Goldstein, Poole, Safko, Classical Mechanics, 3rd edition, 2001, chapters 4 and 5.
"""

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from course.physics.state import Array


def cross(a: Array, b: Array) -> Array:
    """Cross product along the last axis, shape (..., 3); faster on small arrays than NumPy's."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    x = ay * bz - az * by
    vector = np.empty((*x.shape, 3))  # np.stack takes three times as long for a single vector
    vector[..., 0], vector[..., 1], vector[..., 2] = x, az * bx - ax * bz, ax * by - ay * bx
    return vector


def product(p: Array, q: Array) -> Array:
    """Hamilton product p q, the rotation "first q, then p"; shapes (..., 4)."""
    w = p[..., :1] * q[..., :1] - np.sum(p[..., 1:] * q[..., 1:], axis=-1, keepdims=True)
    xyz = p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + cross(p[..., 1:], q[..., 1:])
    return np.concatenate([w, xyz], axis=-1)


def quaternion(rotation_vector: ArrayLike) -> Array:
    """The unit quaternion of a rotation vector (axis times angle, rad); (..., 3) gives (..., 4)."""
    vector = np.asarray(rotation_vector, dtype=float)
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    # sinc keeps its value where the angle is 0 and there is no axis.
    return np.concatenate([np.cos(0.5 * angle), 0.5 * np.sinc(angle / (2 * np.pi)) * vector], axis=-1)


def turn(orientation: Array, vector: Array) -> Array:
    """A vector in the body's axes, (..., 3), expressed in the world's axes."""
    w, axis = orientation[..., :1], orientation[..., 1:]
    twice = 2.0 * cross(axis, vector)
    return np.asarray(vector + w * twice + cross(axis, twice))


def turn_back(orientation: Array, vector: Array) -> Array:
    """A vector of the world, (..., 3), in the body's axes."""
    return turn(orientation * np.array([1.0, -1.0, -1.0, -1.0]), vector)


def kinetic_energy(inertia: ArrayLike, angular_velocity: Array) -> Array:
    """Energy of the rotation, J, shape (...): moments (3,) in kg m², angular velocity (..., 3), body axes."""
    return np.asarray(0.5 * np.sum(np.asarray(inertia, dtype=float) * angular_velocity**2, axis=-1))


def angular_momentum(inertia: ArrayLike, orientation: Array, angular_velocity: Array) -> Array:
    """Angular momentum in the world's axes, kg m²/s, shape (..., 3); constant where there is no torque."""
    return turn(orientation, np.asarray(inertia, dtype=float) * angular_velocity)


class Spin(NamedTuple):
    """Orientation (..., 4) and angular velocity (..., 3; rad/s, the body's axes) of a rotating body."""

    orientation: Array
    angular_velocity: Array


class RotationStepper(Protocol):
    """A method that advances a rotation by one step."""

    def advance(self, inertia: Array, spin: Spin, torque: Array, h: float | Array) -> Spin:
        """The rotation h (s) later.

        Args:
            inertia: principal moments, shape (3,) or (..., 3), kg m².
            torque: in the body's axes, held over the step, shape (..., 3), N m.
            h: a number, or an array of shape (..., 1).
        """
        ...


def _slopes(inertia: Array, spin: Spin, torque: Array) -> tuple[Array, Array]:
    """Time derivatives of orientation and angular velocity."""
    w = spin.angular_velocity
    return 0.5 * product(spin.orientation, _pure(w)), (torque - cross(w, inertia * w)) / inertia


def _pure(vector: Array) -> Array:
    """A vector as a quaternion without a real part."""
    return np.concatenate([np.zeros_like(vector[..., :1]), vector], axis=-1)


class ExplicitEulerRotation:
    """Order 1, and wrong twice: the energy grows, and the quaternion leaves the unit sphere.

    It shows what goes wrong; nothing here uses it for anything else.
    """

    def advance(self, inertia: Array, spin: Spin, torque: Array, h: float | Array) -> Spin:
        dq, dw = _slopes(inertia, spin, torque)
        return Spin(spin.orientation + h * dq, spin.angular_velocity + h * dw)


class RK4Rotation:
    """Order 4, not symplectic: four slopes a step; the quaternion is divided by its length at the end."""

    def advance(self, inertia: Array, spin: Spin, torque: Array, h: float | Array) -> Spin:
        def ahead(share: float, slopes: tuple[Array, Array]) -> Spin:
            return Spin(spin[0] + share * h * slopes[0], spin[1] + share * h * slopes[1])

        k1 = _slopes(inertia, spin, torque)
        k2 = _slopes(inertia, ahead(0.5, k1), torque)
        k3 = _slopes(inertia, ahead(0.5, k2), torque)
        k4 = _slopes(inertia, ahead(1.0, k3), torque)
        q, w = (
            y + h / 6.0 * (a + 2 * b + 2 * c + d) for y, a, b, c, d in zip(spin, k1, k2, k3, k4, strict=True)
        )
        return Spin(q / np.linalg.norm(q, axis=-1, keepdims=True), w)


class SplitRotation:
    """Order 2, symplectic, reversible: half a kick, five exact rotations about the body's axes, half a kick.

    A free body that could turn about only one of its axes would do so at a constant rate, which is solved
    exactly by one small rotation. Doing so about x, y, z, y, x in turn (half, half, whole, half, half) keeps
    the angular momentum in the world to round-off and the energy within a bound for ever, and because every
    step multiplies unit quaternions, the orientation stays one.

    Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, 2006, section VII.5.3; Dullweber,
    Leimkuhler, McLachlan, J. Chem. Phys. 107, 1997.
    """

    def advance(self, inertia: Array, spin: Spin, torque: Array, h: float | Array) -> Spin:
        q = spin.orientation
        momentum = inertia * spin.angular_velocity + 0.5 * h * torque
        for axis, share in ((0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)):
            angle = share * h * momentum[..., axis : axis + 1] / inertia[..., axis : axis + 1]
            q, momentum = _about(axis, angle, q, momentum)
        # Products keep the length to round-off; dividing keeps the round-off from adding up.
        q = q / np.linalg.norm(q, axis=-1, keepdims=True)
        return Spin(q, (momentum + 0.5 * h * torque) / inertia)


def rotate(stepper: RotationStepper, inertia: Array, start: Spin, h: float, n: int) -> tuple[Array, Array]:
    """n steps of h (s) of a body that no torque acts on.

    Returns:
        Orientations (n + 1, 4) and angular velocities (n + 1, 3), rad/s, body axes; the start included.
    """
    spins = [start]
    for _ in range(n):
        spins.append(stepper.advance(inertia, spins[-1], np.zeros(3), h))
    q, w = (np.array(column) for column in zip(*spins, strict=True))
    return q, w


#: q times the unit quaternion of a body axis is q with its components in this order and with these signs.
_ORDER = ([1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0])
_SIGNS = tuple(np.array(signs) for signs in ([-1.0, 1, 1, -1], [-1.0, -1, 1, 1], [-1.0, 1, -1, 1]))


def _about(axis: int, angle: Array, q: Array, momentum: Array) -> tuple[Array, Array]:
    """Turn a body by ``angle`` (..., 1) about one of its axes; they see its momentum turn back."""
    half = 0.5 * angle
    turned = np.cos(half) * q + np.sin(half) * (q[..., _ORDER[axis]] * _SIGNS[axis])
    c, s = np.cos(angle[..., 0]), np.sin(angle[..., 0])
    j, k = (axis + 1) % 3, (axis + 2) % 3
    seen = momentum.copy()
    seen[..., j] = c * momentum[..., j] + s * momentum[..., k]
    seen[..., k] = c * momentum[..., k] - s * momentum[..., j]
    return turned, seen


class ByMomentum:
    """A rotation in the form of a position and a velocity, which any method for ``x'' = a`` can advance.

    The velocity is the angular momentum in the world's axes, which changes by the torque alone. So the
    momentum has the order of the method, and without a torque it is constant. The body turns freely with the
    mean momentum of the motion (``SplitRotation``), which makes the orientation of order 2 or, about a fixed
    axis, of the method's order.

    Args:
        inertia: principal moments, shape (..., 3), kg m².
        start: the rotation at the beginning of the motion.
    """

    def __init__(self, inertia: Array, start: Spin) -> None:
        self._inertia, self._start = inertia, start

    def state(self) -> tuple[Array, Array]:
        """Position and velocity at the start."""
        momentum = angular_momentum(self._inertia, *self._start)
        return np.zeros_like(momentum), momentum

    def spin(self, after: float | Array, x: Array, v: Array) -> Spin:
        """The rotation that belongs to a position and velocity, ``after`` seconds from the start."""
        q = self._start.orientation
        span = np.asarray(after, dtype=float)
        if np.any(span):
            mean = turn_back(q, x / np.where(span == 0, 1.0, span)) / self._inertia
            q, _ = SplitRotation().advance(self._inertia, Spin(q, mean), np.zeros_like(mean), after)
        return Spin(q, turn_back(q, v) / self._inertia)

    def rate(self, torque: Array, x: Array, v: Array) -> Array:  # noqa: ARG002
        """The acceleration of the position under a torque in the world's axes, shape (..., 3), N m."""
        return torque


class ByQuaternion(ByMomentum):
    """The same with the quaternion as position and its derivative as velocity.

    It is of the method's order about any axis. The length of the quaternion is that of a rotation to the
    method's order only, and divided out.
    """

    def state(self) -> tuple[Array, Array]:
        return self._start.orientation, 0.5 * product(self._start.orientation, _pure(self._start[1]))

    def spin(self, after: float | Array, x: Array, v: Array) -> Spin:  # noqa: ARG002
        size = np.linalg.norm(x, axis=-1, keepdims=True)
        inverse = x * np.array([1.0, -1.0, -1.0, -1.0]) / size**2
        return Spin(x / size, 2.0 * product(inverse, v)[..., 1:])

    def rate(self, torque: Array, x: Array, v: Array) -> Array:
        q, w = self.spin(0.0, x, v)
        faster = (turn_back(q, torque) - cross(w, self._inertia * w)) / self._inertia
        return 0.5 * (product(v, _pure(w)) + product(x, _pure(faster)))


#: The methods under the names that the command line and the lessons use.
ROTATION_STEPPERS: dict[str, RotationStepper] = {
    "explicit_euler": ExplicitEulerRotation(),
    "rk4": RK4Rotation(),
    "split": SplitRotation(),
}

"""A ball on a floor in one dimension, under the contact models that engines use.

    penalty       a spring and a damper push back a body that has entered
    constraint    the velocity may not fall below a target; correction by ERP, softness by CFM, split impulse
    soft convex   MuJoCo's: the acceleration is a mean with that of a spring; its weight is called impedance

Each model is a step ``(gap, velocity) -> (gap, velocity)``. All of them compute the new velocity first and
move with it, act only once the ball has touched the floor, and cannot pull. With only one ball and one
contact to solve, the models differ but not the solver.

Source: Catto, Soft Constraints (Game Developers Conference), 2011, and Open Dynamics Engine, Manual (ERP,
CFM); MuJoCo documentation, Computation (solref, solimp); Horak and Trinkle, IEEE RA-L 4, 2019 (comparison).
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from course.physics.state import Array


class ContactModel(Protocol):
    """How a floor treats a ball."""

    def step(self, gap: float, v: float, h: float, g: float) -> tuple[float, float]:
        """Gap (m, negative inside the floor) and upward velocity (m/s) after h (s) under gravity g (m/s²)."""
        ...


@dataclass(frozen=True, slots=True)
class Penalty:
    """A spring and a damper where the ball overlaps the floor.

    Attributes:
        stiffness: N/m. damping: N s/m. mass: kg.
    """

    stiffness: float
    damping: float = 0.0
    mass: float = 1.0

    def step(self, gap: float, v: float, h: float, g: float) -> tuple[float, float]:
        force = max(0.0, -self.stiffness * gap - self.damping * v) if gap < 0 else 0.0
        v += h * (force / self.mass - g)
        return gap + h * v, v


@dataclass(frozen=True, slots=True)
class Constraint:
    """The velocity after the step may not be below a target: complementarity, with the additions of engines.

    Attributes:
        restitution: of impacts faster than ``threshold`` (m/s); slower ones do not bounce.
        erp: error reduction, the fraction of the overlap that a step should remove; the velocity for it is
            added to the target (Baumgarte).
        split: remove it by moving the ball, and keep the velocity out of it (split impulse).
        cfm: constraint force mixing, s/kg: how much the contact yields to its own force.
        mass: kg.
    """

    restitution: float = 0.0
    threshold: float = 0.0
    erp: float = 0.0
    split: bool = False
    cfm: float = 0.0
    mass: float = 1.0

    def step(self, gap: float, v: float, h: float, g: float) -> tuple[float, float]:
        free = v - h * g
        if gap > 0:
            return gap + h * free, free
        bounce = -self.restitution * v if v < -self.threshold else 0.0
        correction = self.erp * -gap / h
        target = bounce if self.split else bounce + correction
        impulse = max(0.0, (target - free) / (1 / self.mass + self.cfm / h))
        v = free + impulse / self.mass
        return gap + h * max(v, correction if self.split else v), v


@dataclass(frozen=True, slots=True)
class SoftConvex:
    """MuJoCo's contact in one dimension, with the defaults of its documentation.

    The acceleration is ``(1 - impedance)`` times the free one plus ``impedance`` times that of a spring and a
    damper, ``-damping v - stiffness gap``, which a time constant and a damping ratio choose (``solref``). The
    impedance grows with the depth (``solimp``, with its midpoint in the middle and its power 2).

    Attributes:
        timeconst: s; dampratio: 1 is critical.
        least, most: the impedance at the surface and from ``width`` (m) on.
    """

    timeconst: float = 0.02
    dampratio: float = 1.0
    least: float = 0.9
    most: float = 0.95
    width: float = 0.001

    def impedance(self, depth: float) -> float:
        """The weight of the spring in the acceleration, at a depth in m."""
        x = min(depth / self.width, 1.0)
        rise = 2 * x**2 if x <= 0.5 else 1 - 2 * (1 - x) ** 2
        return self.least + rise * (self.most - self.least)

    def stiffness(self, depth: float) -> float:
        """Of the spring, at a depth in m; 1/s²."""
        return self.impedance(depth) / (self.most * self.timeconst * self.dampratio) ** 2

    def step(self, gap: float, v: float, h: float, g: float) -> tuple[float, float]:
        a = -g
        if gap < 0:
            spring = -2.0 / (self.most * self.timeconst) * v - self.stiffness(-gap) * gap
            a += max(0.0, self.impedance(-gap) * (spring + g))
        v += h * a
        return gap + h * v, v

    def resting_depth(self, g: float) -> float:
        """How deep the ball sinks in, m: where gravity and the spring balance."""
        low, high = 0.0, g * (self.most * self.timeconst * self.dampratio) ** 2 / self.least**2
        for _ in range(60):  # each halves the bracket; 53 of them exhaust a float
            middle = 0.5 * (low + high)
            d = self.impedance(middle)
            sinks = (1.0 - d) * g > d * self.stiffness(middle) * middle
            low, high = (middle, high) if sinks else (low, middle)
        return high


def erp_cfm(stiffness: float, damping: float, h: float) -> tuple[float, float]:
    """The ERP and the CFM (s/kg) that make a constraint of step h (s) a spring and a damper (N/m, N s/m).

    It is then the spring integrated implicitly, so no stiffness makes it unstable.
    """
    whole = h * stiffness + damping
    return h * stiffness / whole, 1.0 / whole


def drop(model: ContactModel, gap: float, v: float, h: float, n: int, g: float = 9.81) -> tuple[Array, Array]:
    """Let a ball go ``gap`` (m) above the floor with upward velocity v; n steps of h (s).

    Returns:
        Gap and velocity after 0, 1, ... steps, both of shape (n + 1,), m and m/s.
    """
    gaps, speeds = [gap], [v]
    for _ in range(n):
        gap, v = model.step(gap, v, h, g)
        gaps.append(gap)
        speeds.append(v)
    return np.array(gaps), np.array(speeds)


def slide_across(
    angle: float, speed: float, mu: float, h: float, *, limit: str = "cone", g: float = 9.81
) -> Array:
    """The positions of a block that slides over a level floor until it stops; shape (n, 2), m.

    Of the friction that ``limit`` allows, each step applies what takes most energy.

    Args:
        angle: of its velocity, rad, from the x axis; speed: m/s.
        mu: friction; ``mu`` times the weight is its limit along x and along y.
        limit: between the axes: "cone" limits the length of the vector (Coulomb); "outer" each of the two
            alone, a pyramid around the cone, as in ODE; "inner" their sum, a pyramid within it, MuJoCo's.

    Raises:
        ValueError: another limit.
    """
    if limit not in _LIMITS:
        raise ValueError(f"Friction is limited by one of {', '.join(_LIMITS)}, not {limit!r}.")
    v = speed * np.array([math.cos(angle), math.sin(angle)])
    places = [np.zeros(2)]
    while np.any(v != 0):
        v = v - _LIMITS[limit](v, mu * g * h)
        places.append(places[-1] + h * v)
    return np.array(places)


def _to_cone(v: Array, most: float) -> Array:
    return v * min(1.0, most / float(np.linalg.norm(v)))


def _to_outer(v: Array, most: float) -> Array:
    return np.asarray(np.clip(v, -most, most))


def _to_inner(v: Array, most: float) -> Array:
    """The nearest vector with ``|x| + |y|`` of at most ``most``."""
    size = np.abs(v)
    over = min(max(0.0, 0.5 * (size.sum() - most)), float(size.min()))
    return np.asarray(np.sign(v) * np.minimum(size - over, most))


#: What each allows of the friction that would stop the block in a step, N s/kg.
_LIMITS = {"cone": _to_cone, "outer": _to_outer, "inner": _to_inner}

"""Scenarios without contact: errors there come from the integrator or a joint."""

from __future__ import annotations

import math
import statistics
from typing import TYPE_CHECKING, Any

import numpy as np

from course.engines.base import Body, EngineDivergedError, Scene, energy
from course.physics import integrators as ode
from course.physics.systems import Pendulum

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from course.engines.base import World

    Array = NDArray[np.float64]
    Build = Callable[[Scene], World]
    Measured = tuple[float, dict[str, Any]]

__all__ = ["double_pendulum", "free_fall", "long_step", "pendulum"]

G = 9.81
#: 200 steps of 1/240 s.
FALL_S = 200.0 / 240.0
SWING_S = 2.0
DOUBLE_S = 10.0
#: The reference of the pendulum is computed with steps no longer than this, s; its error is below 1e-11 m.
_FINE_S = 1e-3
_BOB = 0.05
#: How often the energy of the double pendulum is looked at, s.
_LOOK_S = 1.0 / 30.0
#: Where the arms of the double pendulum start, degrees from hanging. More than one, since it is chaotic.
STARTS_DEG = (90.0, 92.0, 94.0, 96.0, 98.0)

#: A step is acceptable as long as the energy never changes by more than this, per cent.
KEPT_PERCENT = 10.0


def free_fall(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001 - it is quick as it is
    """By how many per cent a body falls too far."""
    n = round(FALL_S / dt)
    scene = Scene((Body("ball", 0.1, 1.0, (0.0, 0.0, 0.0)),), dt=dt)
    world = build(scene)
    world.step(n)
    fallen = -world.motion().checked().x[0, 2]
    true = 0.5 * G * (n * dt) ** 2
    return 100.0 * (fallen / true - 1.0), {"steps": n, "fallen_m": float(fallen), "true_m": true}


def _bob(angle: float, mass: float = 1.0, top: tuple[float, float] = (0.0, 0.0)) -> Body:
    """A ball at the end of a rod of 1 m that hangs at ``angle`` (rad) from the vertical."""
    return Body("ball", _BOB, mass, (top[0] + math.sin(angle), 0.0, top[1] - math.cos(angle)))


def _path(n: int, dt: float) -> Array:
    """Where the bob of the pendulum should be at every step, (n + 1, 3), m."""
    bob = _bob(math.pi / 2)
    # About the hinge the ball turns with its own inertia too: theta'' = -g m L / (m L² + I) sin(theta).
    system = Pendulum(length=1.0 + bob.inertia / bob.mass, g=G)
    parts = max(1, math.ceil(dt / _FINE_S))
    start = ode.State.at_rest([math.pi / 2])
    run = ode.trajectory(ode.STEPPERS["rk4"], system, start, dt / parts, n * parts)
    angle = run.q[::parts, 0]
    return np.stack([np.sin(angle), 0.0 * angle, -np.cos(angle)], -1)


def pendulum(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001
    """How far a swinging ball deviates from its true path, in per cent of the rod."""
    n = round(SWING_S / dt)
    scene = Scene((_bob(math.pi / 2),), pivots=((0.0, 0.0, 0.0),), dt=dt)
    world = build(scene)
    x = [scene.bodies[0].position]
    for _ in range(n):
        world.step()
        x.append(tuple(world.motion().checked().x[0]))
    off = np.linalg.norm(np.array(x) - _path(n, dt), axis=1)
    rest = -G
    start = 0.0 - rest
    left = energy(scene, world.motion()) - rest
    return 100.0 * float(off.max()), {"steps": n, "energy_change_percent": 100.0 * (left / start - 1.0)}


def double_pendulum(build: Build, dt: float, quick: bool) -> Measured:
    """The largest change of energy within ten seconds, per cent; the median over five starts (quick: three).

    The change at the end would depend on the phase of the swing at that moment, even in its sign.
    """
    starts = STARTS_DEG[:3] if quick else STARTS_DEG
    runs = [_energy_change(build, dt, math.radians(degrees)) for degrees in starts]
    largest, last = zip(*runs, strict=True)
    details = {"starts_deg": list(starts), "largest_percent": list(largest), "at_the_end_percent": list(last)}
    return statistics.median(largest), {"samples": list(largest), **details}


def long_step(build: Build, dt: float, quick: bool) -> Measured:
    """The longest step with which the double pendulum keeps its energy to 10 % for ten seconds, ms.

    Steps of 1, 2, 4, 8 and 16 times ``dt`` are tried, up to the first that fails. A run that ends in a value
    that is not a number has failed. The start with the shortest step counts.
    """
    starts = STARTS_DEG[:3] if quick else STARTS_DEG
    samples = [1000.0 * _longest(build, dt, math.radians(degrees)) for degrees in starts]
    return min(samples), {"samples": samples, "starts_deg": list(starts), "longest_tried_ms": 16e3 * dt}


def _longest(build: Build, dt: float, angle: float) -> float:
    borne = 0.0
    for factor in (1, 2, 4, 8, 16):
        try:
            largest, _ = _energy_change(build, factor * dt, angle)
        except EngineDivergedError:
            break
        if largest > KEPT_PERCENT:
            break
        borne = factor * dt
    return borne


def _energy_change(build: Build, dt: float, angle: float) -> tuple[float, float]:
    """The largest change, regardless of sign, and the one at the end; per cent of what there was."""
    upper = _bob(angle)
    elbow = (upper.position[0], upper.position[2])
    lower = _bob(angle, top=elbow)
    scene = Scene((upper, lower), pivots=((0.0, 0.0, 0.0), upper.position), dt=dt)
    world = build(scene)
    hanging = -G * (1.0 + 2.0)
    before = energy(scene, world.motion()) - hanging
    n, each = round(DOUBLE_S / dt), max(1, round(_LOOK_S / dt))
    largest = change = 0.0
    for done in range(0, n, each):
        world.step(min(each, n - done))
        change = 100.0 * ((energy(scene, world.motion().checked()) - hanging) / before - 1.0)
        largest = max(largest, abs(change))
    return largest, change

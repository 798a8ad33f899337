"""The floor decides: friction and restitution swept, and how little of the outcome the step decides."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.integrators import SemiImplicitEuler
from course.physics.simulator import Simulator, step_count
from course.physics.state import RigidBodyState
from course.simulations.base import Column, Parameter, Result, Row, Simulation, step
from course.simulations.words import digits, percent

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["SIMULATION"]

_RADIUS = 0.1  # m
_SHOWN_FRICTION = (0.1, 0.3, 0.6)
_SHOWN_RESTITUTION = (0.3, 0.5, 0.9)
#: The whole sweep, as friction of one experiment and restitution of the other.
_SWEEP = np.round(np.arange(0.05, 1.0001, 0.05), 2)


def _run(p: Mapping[str, Any]) -> Result:
    stopping = _slide(p, _SWEEP)
    rebound = _drop(p, _SWEEP)
    stops = p["speed"] ** 2 / (2 * _SWEEP * p["gravity"])
    rises = _SWEEP**2 * p["height"]
    rows = [
        Row(
            f"sliding to rest, friction {x:g}",
            float(stopping[_at(x)]),
            "m",
            float(stops[_at(x)]),
            "v² / (2 μ g)",
        )
        for x in _SHOWN_FRICTION
    ]
    rows += [
        Row(
            f"rebound, restitution {x:g}",
            float(rebound[_at(x)]),
            "m",
            float(rises[_at(x)]),
            "e² times the drop",
        )
        for x in _SHOWN_RESTITUTION
    ]
    guess = 0.3
    wrong = float(_slide(p, np.array([0.9 * guess]))[0]) / float(stopping[_at(guess)]) - 1
    numeric = abs(float(stopping[_at(guess)] / stops[_at(guess)]) - 1)
    rows.append(Row("sliding further, friction 10 % lower", wrong, "1", 1 / 0.9 - 1, "1 / 0.9 - 1"))
    return Result(
        simulation="environment",
        settings=p,
        rows=tuple(rows),
        headline=f"Friction 10 % off moves the stop by {percent(wrong)}; this step by {percent(numeric)}",
        finding=f"From {p['speed']:g} m/s a block slides {digits(float(stopping[_at(0.6)]), 2)} m at a "
        f"friction of 0.6 and {digits(float(stopping[_at(0.1)]), 2)} m at 0.1. If the true friction is 10 % "
        f"lower than the modelled one, the block ends {percent(wrong)} further away; the step of "
        f"{p['step']:g} s makes an error of "
        f"{percent(numeric)}. Measure the floor before you refine the step.",
        columns=(
            Column.of("coefficient", "1", _SWEEP),
            Column.of("stopping_distance", "m", stopping),
            Column.of("stopping_distance_theory", "m", stops),
            Column.of("rebound", "m", rebound),
            Column.of("rebound_theory", "m", rises),
        ),
    )


def _at(coefficient: float) -> int:
    return int(np.argmin(np.abs(_SWEEP - coefficient)))


def _steps(seconds: float, h: float) -> float:
    """A duration of whole steps, a little longer than ``seconds``."""
    duration = (math.ceil(seconds / h) + 2) * h
    if step_count(duration, h) > 20_000:
        raise ValueError(
            f"with a step of {h:g} s this takes more than 20,000 steps; take a larger step, or a lower speed."
        )
    return duration


def _slide(p: Mapping[str, Any], friction: Array) -> Array:
    """How far a block slides on each floor, m: one simulation, all floors at once."""
    block = Body.sphere(
        1.0, _RADIUS, RigidBodyState.of([0.0, 0.0, _RADIUS], [p["speed"], 0.0, 0.0]), spins=False
    )
    # Velocity before position, as in most engines: of first order, so that the step has an error to show.
    engine = Simulator(
        [block],
        h=p["step"],
        gravity=p["gravity"],
        surface=Surface(0.0, friction),
        stepper=SemiImplicitEuler(),
    )
    slowest = p["speed"] / (float(friction.min()) * p["gravity"])
    record = engine.run(_steps(slowest, p["step"]))
    return np.asarray(record.position[-1, 0, :, 0])


def _drop(p: Mapping[str, Any], restitution: Array) -> Array:
    """How high a ball bounces from each floor, m: the top of its first rebound."""
    g, h = p["gravity"], p["step"]
    ball = Body.sphere(1.0, _RADIUS, RigidBodyState.of([0.0, 0.0, _RADIUS + p["height"]]), spins=False)
    engine = Simulator([ball], h=h, gravity=g, surface=Surface(restitution))
    fall = math.sqrt(2 * p["height"] / g)
    record = engine.run(_steps(2.05 * fall, h))
    heights = record.position[:, 0, :, 2] - _RADIUS
    speeds = record.velocity[:, 0, :, 2]
    rising = (record.t[:, None] > record.ground_time[0]) & (speeds > 0)
    # From its first sample on the way up the top follows exactly.
    first, each = np.argmax(rising, axis=0), np.arange(restitution.size)
    tops = heights[first, each] + speeds[first, each] ** 2 / (2 * g)
    return np.where(rising.any(axis=0), tops, 0.0)


SIMULATION = Simulation(
    id="environment",
    title="Environment: the floor decides",
    question="If the real friction is 10 % lower than the modelled one, how much further does the block "
    "slide? And how small must the step be to make up for it?",
    teaches="environmental modelling",
    parameters=(
        Parameter("speed", 2.0, "m/s", "of the sliding block at the start", low=0.1, high=20.0),
        Parameter("height", 1.0, "m", "that the ball is dropped from", low=0.01, high=100.0),
        Parameter("gravity", 9.81, "m/s²", "acceleration downwards", low=0.1, high=100.0),
        step(high=0.05),
    ),
    run=_run,
)

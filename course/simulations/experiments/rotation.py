"""A body spun about its middle axis: it turns over by itself, and a naive method invents energy."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.body import Body
from course.physics.rotation import ROTATION_STEPPERS, Spin, angular_momentum, kinetic_energy
from course.physics.simulator import step_count
from course.physics.state import RigidBodyState
from course.simulations.base import Column, Parameter, Result, Row, Simulation, duration, step
from course.simulations.words import percent, times

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["SIMULATION"]

_NAMES = {"explicit_euler": "explicit Euler", "rk4": "Runge-Kutta 4", "split": "split rotations"}


def _run(p: Mapping[str, Any]) -> Result:
    inertia = np.array([p["inertia1"], p["inertia2"], p["inertia3"]])
    start = RigidBodyState.of(np.zeros(3), angular_velocity=[p["nudge"], p["spin"], p["nudge"]])
    Body(1.0, start, inertia=inertia)  # refuses moments that no body has
    if not start.angular_velocity.any():
        raise ValueError("a body that does not turn has no rotation to show; set spin or nudge.")
    n = step_count(p["duration"], p["step"])
    # Explicit Euler may run away to infinity; that is its result.
    with np.errstate(over="ignore", invalid="ignore"):
        runs = {name: _spin(name, inertia, start, p["step"], n) for name in _NAMES}
        drifts = {
            name: np.nan_to_num(kinetic_energy(inertia, w) / kinetic_energy(inertia, w[0]) - 1.0, nan=np.inf)
            for name, (_, w) in runs.items()
        }
    w = runs["split"][1]
    t = p["step"] * np.arange(n + 1)
    flips = int(np.count_nonzero(np.diff(np.sign(w[:, 1]))))
    rows = (
        *_energy_rows(drifts, {name: q for name, (q, _) in runs.items()}),
        Row("angular momentum lost, split rotations", _momentum_drift(inertia, *runs["split"]), "1", 0.0,
            "no torque, share of it"),
        *_growth(p, inertia, t, w),
        Row("times it turned over", flips, "1"),
    )  # fmt: skip
    return Result(
        simulation="rotation",
        settings=p,
        rows=rows,
        headline=_headline(p, flips, float(drifts["explicit_euler"][-1])),
        finding=_finding(p, flips, drifts),
        columns=(
            Column.of("t", "s", t),
            *(Column.of(f"w{k + 1}", "rad/s", w[:, k]) for k in range(3)),
            *(Column.of(f"energy_error_{name}", "1", drift) for name, drift in drifts.items()),
        ),
    )


def _spin(name: str, inertia: Array, start: RigidBodyState, h: float, n: int) -> tuple[Array, Array]:
    """Orientations (n + 1, 4) and angular velocities (n + 1, 3) of a body that no torque acts on."""
    method = ROTATION_STEPPERS[name]
    spin = Spin(start.orientation, start.angular_velocity)
    q, w = np.empty((n + 1, 4)), np.empty((n + 1, 3))
    q[0], w[0] = spin
    for i in range(n):
        spin = method.advance(inertia, spin, np.zeros(3), h)
        q[i + 1], w[i + 1] = spin
    return q, w


def _energy_rows(drifts: Mapping[str, Array], orientations: Mapping[str, Array]) -> list[Row]:
    rows = [
        Row(f"energy gained, {_NAMES[name]}", float(drift[-1]), "1", 0.0, "no torque, share of it")
        for name, drift in drifts.items()
    ]
    rows += [
        Row(f"length of the quaternion, {_NAMES[name]}", float(np.linalg.norm(q[-1])), "1", 1.0, "a rotation")
        for name, q in orientations.items()
    ]
    return rows


def _momentum_drift(inertia: Array, q: Array, w: Array) -> float:
    momentum = angular_momentum(inertia, q, w)
    return float(np.max(np.linalg.norm(momentum - momentum[0], axis=-1)) / np.linalg.norm(momentum[0]))


def _growth(p: Mapping[str, Any], inertia: Array, t: Array, w: Array) -> list[Row]:
    """How fast a small wobble grows about the middle axis, read off while it is small."""
    i1, i2, i3 = inertia
    square = (i2 - i1) * (i3 - i2) / (i1 * i3)
    if not square > 0 or p["spin"] == 0 or p["nudge"] == 0:
        return []
    due = abs(p["spin"]) * math.sqrt(square)
    # A fading wobble hides in the first moments, and a large one turns the body over.
    wobble = np.hypot(w[:, 0], w[:, 2] * math.sqrt(i3 * (i3 - i2) / (i1 * (i2 - i1))))
    fit = (t > 1.5 / due) & (wobble < 0.05 * abs(p["spin"]))
    last = int(np.argmax(wobble >= 0.05 * abs(p["spin"]))) or t.size
    fit[last:] = False
    if np.count_nonzero(fit) < 5:
        return []
    slope = float(np.polyfit(t[fit], np.log(wobble[fit]), 1)[0])
    return [Row("growth of the wobble", slope, "1/s", due, "ω √((I₂ - I₁)(I₃ - I₂) / (I₁ I₃))")]


def _headline(p: Mapping[str, Any], flips: int, gained: float) -> str:
    if abs(p["spin"]) * p["step"] > 0.5:
        return "The body turns too far in one step for these methods to follow"
    turns = f"The body flips over {times(flips)}" if flips else "The body never flips over"
    if gained > 10:
        return f"{turns}, and explicit Euler's energy explodes"
    return f"{turns}, and explicit Euler adds {percent(gained)} of energy"


def _finding(p: Mapping[str, Any], flips: int, drifts: Mapping[str, Array]) -> str:
    angle = abs(p["spin"]) * p["step"]
    if angle > 0.5:
        return (
            f"The body turns by {angle:.2g} rad in one step, too far for any of these methods to follow. "
            f"Take a step below {0.5 / abs(p['spin']):.2g} s."
        )
    moments = [p["inertia1"], p["inertia2"], p["inertia3"]]
    middle = sorted(moments)[1] == p["inertia2"] and len(set(moments)) == 3
    axis = (
        f"Axis 2 is the middle one, and a spin about it does not last: the body flipped over {times(flips)}."
        if middle and flips
        else "Axis 2 is the middle one, but the wobble has not yet had time to flip the body over."
        if middle
        else "Axis 2 is not the middle one, and a spin about it is stable."
    )
    return (
        f"{axis} No torque acts, so the energy must not change: explicit Euler gains "
        f"{percent(float(drifts['explicit_euler'][-1]))} in {p['duration']:g} s and stretches the "
        f"quaternion, while split rotations stay within {percent(float(np.max(np.abs(drifts['split']))))} "
        "and keep the "
        "angular momentum to round-off."
    )


SIMULATION = Simulation(
    id="rotation",
    title="Rotation: the wing nut that flips over",
    question="Nothing touches a body that spins about its middle axis. What does it do, and what does "
    "explicit Euler do to its energy in 20 s?",
    teaches="rigid bodies; time step",
    parameters=(
        Parameter("inertia1", 1.0, "kg m²", "moment about axis 1", low=1e-6, high=1e6),
        Parameter(
            "inertia2", 2.0, "kg m²", "moment about axis 2, the one it spins about", low=1e-6, high=1e6
        ),
        Parameter("inertia3", 3.0, "kg m²", "moment about axis 3", low=1e-6, high=1e6),
        Parameter("spin", 5.0, "rad/s", "about axis 2 at the start", low=-1000.0, high=1000.0),
        Parameter("nudge", 0.01, "rad/s", "about axes 1 and 3 at the start", low=-10.0, high=10.0),
        duration(20.0),
        step(high=0.1),
    ),
    run=_run,
)

"""One spring, four methods: where do they put it, and what do they do to its energy?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.integrators import STEPPERS, State, trajectory
from course.physics.invariants import energy, relative_change
from course.physics.simulator import step_count
from course.physics.systems import Oscillator
from course.simulations.base import Column, Parameter, Result, Row, Simulation, duration, step
from course.simulations.words import METHOD_NAMES, digits, percent

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["SIMULATION"]


def _run(p: Mapping[str, Any]) -> Result:
    w, h = p["omega"], p["step"]
    n = step_count(p["duration"], h)
    t = h * np.arange(n + 1)
    exact = p["amplitude"] * np.cos(w * t) + p["speed"] / w * np.sin(w * t)
    spring, start = Oscillator(omega=w), State.of([p["amplitude"]], [p["speed"]])
    positions: dict[str, Array] = {}
    drifts: dict[str, Array] = {}
    # A method beyond its limit overflows; infinity is then the honest answer.
    with np.errstate(over="ignore", invalid="ignore"):
        for name, method in STEPPERS.items():
            path = trajectory(method, spring, start, h, n)
            positions[name] = path.q[:, 0]
            drifts[name] = np.nan_to_num(relative_change(energy(spring, path.q, path.v)), nan=np.inf)
    worst = {name: float(np.max(np.abs(drift))) for name, drift in drifts.items()}
    where = f"position at {p['duration']:g} s"
    rows = [
        Row(f"{where}, {METHOD_NAMES[name]}", float(q[-1]), "m", float(exact[-1]), "A cos ωt + (v₀/ω) sin ωt")
        for name, q in positions.items()
    ]
    theory = _energy_theory(p, w * h, n)
    rows += [
        Row(f"largest energy error, {METHOD_NAMES[name]}", worst[name], "1", *theory[name])
        for name in STEPPERS
    ]
    return Result(
        simulation="integrators",
        settings=p,
        rows=tuple(rows),
        headline=_headline(worst),
        finding=_finding(p, rows, worst),
        columns=(
            Column.of("t", "s", t),
            Column.of("exact", "m", exact),
            *(Column.of(name, "m", q) for name, q in positions.items()),
            *(Column.of(f"energy_error_{name}", "1", drift) for name, drift in drifts.items()),
        ),
    )


def _energy_theory(p: Mapping[str, Any], z: float, n: int) -> dict[str, tuple[float | None, str]]:
    """The largest relative energy error that theory allows each method, and where it comes from."""
    with np.errstate(over="ignore"):
        explicit = float(np.float64(1.0 + z * z) ** n) - 1.0
    # The bounds hold from rest, below the limit, and for runs long enough to reach them.
    plain = p["speed"] == 0.0 and z < 2.0 and z * n > 2 * math.pi
    return {
        "explicit_euler": (explicit, "(1 + z²)ⁿ - 1, z = h ω"),
        "semi_implicit_euler": (z / (2 - z) if plain else None, "bound z / (2 - z)"),
        "velocity_verlet": (z * z / 4 if plain else None, "bound z² / 4"),
        "rk4": (n * z**6 / 72 if z < 0.3 and n * z**6 < 1 else None, "n z⁶ / 72"),
    }


def _headline(worst: Mapping[str, float]) -> str:
    if worst["velocity_verlet"] > 1.0:
        return "Beyond h ω = 2 even the symplectic methods blow up"
    return "Explicit Euler's energy keeps growing; the symplectic methods' does not"


def _finding(p: Mapping[str, Any], rows: list[Row], worst: Mapping[str, float]) -> str:
    z = p["omega"] * p["step"]
    off = [abs(row.error or 0.0) for row in rows[:4]]
    if z >= 2.0:
        return (
            f"Step times frequency is {z:.3g}, beyond the limit of 2 for semi-implicit Euler and Verlet"
            f"{' and 2.83 for Runge-Kutta' if z > 2 * math.sqrt(2) else ''}: these results mean nothing. "
            f"Take a step below {2 / p['omega']:.3g} s."
        )
    return (
        f"At {p['duration']:g} s explicit Euler is off by {digits(off[0])} m and semi-implicit Euler by "
        f"{digits(off[1])} m: the same two lines in another order. Explicit Euler's energy grows with every "
        f"step, to {digits(1 + worst['explicit_euler'])} times the start; semi-implicit Euler and Verlet "
        "stay "
        f"within {percent(worst['semi_implicit_euler'])} and {percent(worst['velocity_verlet'])}, however "
        "long "
        f"the run, and Runge-Kutta, now at {percent(worst['rk4'])}, goes on losing a little."
    )


SIMULATION = Simulation(
    id="integrators",
    title="Four methods on one spring",
    question="Two of these methods differ only in the order of two lines. How much worse is the worse one "
    "after 5 s: a little, ten times, a hundred times?",
    teaches="time step",
    parameters=(
        Parameter("omega", 2.0, "rad/s", "frequency of the spring, √(k/m)", low=0.01, high=1e4),
        Parameter("amplitude", 1.0, "m", "where the mass is released", low=1e-6, high=1e6),
        Parameter("speed", 0.0, "m/s", "velocity at the start", low=-1e6, high=1e6),
        duration(5.0),
        step(high=10.0),
    ),
    run=_run,
)

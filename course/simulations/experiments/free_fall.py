"""A ball is let go: when does it land, and what does each method make of the simplest motion there is?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.integrators import STEPPERS, State, trajectory
from course.physics.simulator import Simulator, step_count
from course.physics.state import RigidBodyState
from course.physics.systems import FreeFall
from course.simulations.base import METHOD, Column, Parameter, Result, Row, Simulation, duration, step
from course.simulations.words import METHOD_NAMES, digits

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["SIMULATION"]


def _run(p: Mapping[str, Any]) -> Result:
    height, speed, g, h = p["height"], p["speed"], p["gravity"], p["step"]
    ball = Body(1.0, RigidBodyState.of([0.0, 0.0, height], [0.0, 0.0, speed]))
    engine = Simulator([ball], h=h, gravity=g, surface=Surface(0.0), stepper=STEPPERS[p["method"]])
    record = engine.run(p["duration"])
    landed = float(record.ground_time[0])
    due = (speed + math.sqrt(speed**2 + 2 * g * height)) / g
    lands = due <= p["duration"]
    exact = np.where(record.t < due, height + speed * record.t - 0.5 * g * record.t**2, 0.0)
    rows = (
        Row("time to the ground", landed, "s", due if lands else math.nan, "(v₀ + √(v₀² + 2 g h₀)) / g"),
        *_without_ground(p),
    )
    bias = 0.5 * g * h * p["duration"]
    when = (
        f"The ball reaches the ground after {digits(landed, 4)} s; theory says {digits(due, 4)} s."
        if math.isfinite(landed)
        else f"The ball is still falling after {p['duration']:g} s; it would land after {due:.4g} s."
    )
    return Result(
        simulation="free-fall",
        settings=p,
        rows=rows,
        headline=_headline(landed, bias, p["duration"]),
        finding=f"{when} Under constant gravity Verlet and Runge-Kutta are exact. Semi-implicit Euler moves "
        f"with a velocity that is half a step ahead, so it is too low by g h t / 2, here {digits(bias)} "
        "m, "
        "and explicit Euler is too high by the same amount: the sign shows what an engine updates first.",
        columns=(
            Column.of("t", "s", record.t),
            Column.of("height", "m", record.position[:, 0, 2]),
            Column.of("height_theory", "m", exact),
            *_errors(p),
        ),
    )


def _headline(landed: float, bias: float, seconds: float) -> str:
    start = (
        f"Down after {digits(landed, 4)} s" if math.isfinite(landed) else f"Still falling at {seconds:g} s"
    )
    return f"{start}; the two Eulers miss by {digits(bias)} m, one each way"


def _fall(p: Mapping[str, Any], method: str) -> tuple[np.ndarray, np.ndarray]:
    """Heights of a fall that no ground stops, and how far they are off; shapes (n + 1,)."""
    start = State.of([p["height"]], [p["speed"]])
    n = step_count(p["duration"], p["step"])
    path = trajectory(STEPPERS[method], FreeFall(g=p["gravity"]), start, p["step"], n)
    exact = p["height"] + p["speed"] * path.t - 0.5 * p["gravity"] * path.t**2
    return path.q[:, 0], path.q[:, 0] - exact


def _without_ground(p: Mapping[str, Any]) -> list[Row]:
    t = p["duration"]
    exact = p["height"] + p["speed"] * t - 0.5 * p["gravity"] * t**2
    rows = [
        Row(f"height at {t:g} s without ground, {METHOD_NAMES[m]}", float(_fall(p, m)[0][-1]), "m", exact,
            "h₀ + v₀ t - g t² / 2")
        for m in STEPPERS
    ]  # fmt: skip
    bias = float(_fall(p, "semi_implicit_euler")[1][-1])
    rows.append(
        Row("bias of semi-implicit Euler", bias, "m", -0.5 * p["gravity"] * p["step"] * t, "-g h t / 2")
    )
    return rows


def _errors(p: Mapping[str, Any]) -> list[Column]:
    return [Column.of(f"error_{method}", "m", _fall(p, method)[1]) for method in STEPPERS]


SIMULATION = Simulation(
    id="free-fall",
    title="Free fall: when does it land?",
    question="A ball falls 10 m. Which methods get the time right to the last digit, and in which direction "
    "are the others wrong?",
    teaches="time step",
    parameters=(
        Parameter(
            "height", 10.0, "m", "where the ball starts, above the ground", low=0.0, high=1e5, above=True
        ),
        Parameter("speed", 0.0, "m/s", "upward speed at the start", low=-1000.0, high=1000.0),
        Parameter("gravity", 9.81, "m/s²", "acceleration downwards", low=0.01, high=1000.0),
        duration(2.0),
        step(),
        METHOD,
    ),
    run=_run,
)

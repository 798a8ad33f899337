"""A stone is thrown: how high, how far, and what does leaving the air out of the model cost?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.integrators import STEPPERS
from course.physics.interpolation import first_crossing, hermite
from course.physics.simulator import Simulator
from course.physics.state import RigidBodyState
from course.simulations.base import METHOD, Column, Parameter, Result, Row, Simulation, duration, step
from course.simulations.words import percent

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from course.physics.recording import Recording

__all__ = ["SIMULATION"]


def _run(p: Mapping[str, Any]) -> Result:
    drag = p["drag"]

    def air(t: Any, bodies: Sequence[Body]) -> None:  # noqa: ARG001 - a law takes the time
        for body in bodies:
            v = body.state.velocity
            body.add_force(-body.mass * drag * np.linalg.norm(v, axis=-1, keepdims=True) * v)

    stone = Body(0.5, RigidBodyState.of([0.0, 0.0, p["height"]], [p["speed_x"], 0.0, p["speed_z"]]))
    engine = Simulator(
        [stone],
        h=p["step"],
        gravity=p["gravity"],
        # Where it lands it stays: no bounce, and friction enough to hold anything.
        surface=Surface(0.0, 1e9),
        stepper=STEPPERS[p["method"]],
        laws=[air] if drag > 0 else [],
    )
    record = engine.run(p["duration"])
    rows = (*_apex_rows(p, record), *_landing_rows(p, record))
    t, x, z = record.t, record.position[:, 0, 0], record.position[:, 0, 2]
    flight = np.minimum(t, _flight_time(p))
    return Result(
        simulation="projectile",
        settings=p,
        rows=rows,
        headline=_headline(p, rows),
        finding=_finding(p, rows),
        columns=(
            Column.of("t", "s", t),
            Column.of("x", "m", x),
            Column.of("z", "m", z),
            Column.of("x_theory", "m", p["speed_x"] * flight),
            Column.of("z_theory", "m", p["height"] + p["speed_z"] * flight - 0.5 * p["gravity"] * flight**2),
        ),
    )


def _flight_time(p: Mapping[str, Any]) -> float:
    """Time to the ground without air, s."""
    up, g = p["speed_z"], p["gravity"]
    return float((up + math.sqrt(up**2 + 2 * g * p["height"])) / g)


def _apex_rows(p: Mapping[str, Any], record: Recording) -> tuple[Row, Row, Row]:
    """The highest point: where the climb rate falls through zero."""
    t, h = record.t, p["step"]
    x, z = record.position[:, 0, 0], record.position[:, 0, 2]
    u, w = record.velocity[:, 0, 0], record.velocity[:, 0, 2]
    up, g = p["speed_z"], p["gravity"]
    due = up / g if up > 0 else 0.0
    flying = t <= np.nan_to_num(record.ground_time[0], nan=np.inf)
    when = first_crossing(t, np.where(flying, w, -1.0), np.full_like(t, -g)) if up > 0 else 0.0
    if math.isnan(when):
        top, out = math.nan, math.nan
    else:
        i = min(int(when / h), t.size - 2)
        s = (when - t[i]) / h
        top = float(hermite(s, z[i], z[i + 1], h * w[i], h * w[i + 1]))
        out = float(hermite(s, x[i], x[i + 1], h * u[i], h * u[i + 1]))
    reached = due <= p["duration"]
    return (
        Row("time of the highest point", when, "s", due if reached else math.nan, "v_z / g"),
        Row(
            "greatest height",
            top,
            "m",
            p["height"] + up * due / 2 if reached else math.nan,
            "z₀ + v_z² / (2 g)",
        ),
        Row("distance there", out, "m", p["speed_x"] * due if reached else math.nan, "v_x v_z / g"),
    )


def _landing_rows(p: Mapping[str, Any], record: Recording) -> tuple[Row, Row]:
    due = _flight_time(p)
    reached = due <= p["duration"]
    landed = float(record.ground_time[0])
    far = float(record.position[-1, 0, 0]) if math.isfinite(landed) else math.nan
    return (
        Row("time of landing", landed, "s", due if reached else math.nan, "(v_z + √(v_z² + 2 g z₀)) / g"),
        Row("distance of landing", far, "m", p["speed_x"] * due if reached else math.nan, "v_x times that"),
    )


def _headline(p: Mapping[str, Any], rows: tuple[Row, ...]) -> str:
    top, far = rows[1].simulated, rows[4]
    if math.isnan(far.simulated):
        return f"Still in the air after {p['duration']:g} s"
    if p["drag"] > 0 and far.theory:
        lost = percent(1 - far.simulated / far.theory)
        return f"Air takes {lost} of the range: the model matters, not the step"
    return f"Up to {top:.4g} m, down again {far.simulated:.5g} m away, as theory says"


def _finding(p: Mapping[str, Any], rows: tuple[Row, ...]) -> str:
    apex, top, out, landed, far = rows
    if math.isnan(landed.simulated):
        return f"After {p['duration']:g} s it is still in the air; a longer duration lets it land."
    flight = (
        f"It rises to {top.simulated:.4g} m at {apex.simulated:.4g} s, {out.simulated:.5g} m out, and lands "
        f"after {landed.simulated:.4g} s, {far.simulated:.5g} m away."
    )
    if p["drag"] > 0 and far.theory:
        return (
            f"{flight} The theory beside it has no air and is {far.theory - far.simulated:.3g} m off at "
            "the landing. No smaller step repairs that, because the air is missing in the model."
        )
    if p["method"] in ("explicit_euler", "semi_implicit_euler"):
        return f"{flight} The difference from theory is the error of this method; it shrinks with the step."
    return f"{flight} The samples are {p['step']:g} s apart; interpolation finds the moments between them."


SIMULATION = Simulation(
    id="projectile",
    title="A throw: how high and how far?",
    question="A ball is thrown at 10 m/s forwards and 10 m/s upwards. How far does it go? And with air?",
    teaches="model complexity",
    parameters=(
        Parameter("speed_x", 10.0, "m/s", "forward speed at the start", low=0.0, high=1000.0),
        Parameter("speed_z", 10.0, "m/s", "upward speed at the start", low=-1000.0, high=1000.0),
        Parameter("height", 0.0, "m", "where it starts, above the ground", low=0.0, high=1e5),
        Parameter("gravity", 9.81, "m/s²", "acceleration downwards", low=0.01, high=1000.0),
        Parameter("drag", 0.0, "1/m", "air: deceleration is drag times speed squared", low=0.0, high=1.0),
        duration(3.0),
        step(),
        METHOD,
    ),
    run=_run,
)

"""Two balls meet head on: when, how fast do they part, and what is kept?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.simulator import Simulator
from course.physics.state import RigidBodyState
from course.simulations.base import Column, Parameter, Result, Row, Simulation, duration, step
from course.simulations.words import percent

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["SIMULATION"]


def _run(p: Mapping[str, Any]) -> Result:
    half, r, e = p["distance"] / 2, p["radius"], p["restitution"]
    if p["distance"] <= 2 * r:
        raise ValueError(
            f"balls of radius {r:g} m overlap from the start at a distance of {p['distance']:g} m; "
            f"take a distance above {2 * r:g} m."
        )
    engine = Simulator(
        [
            Body.sphere(p["mass1"], r, RigidBodyState.of([-half, 0.0, 0.0], [p["speed1"], 0.0, 0.0])),
            Body.sphere(p["mass2"], r, RigidBodyState.of([half, 0.0, 0.0], [p["speed2"], 0.0, 0.0])),
        ],
        h=p["step"],
        gravity=0.0,
        ground=None,
        surface=Surface(e),
    )
    record = engine.run(p["duration"])
    met = float(record.first_contact[0, 1])
    due, after1, after2 = _theory(p)
    x, v = record.position[:, :, 0], record.velocity[:, :, 0]
    momentum, energy = record.momentum()[:, 0], record.energy()
    meets = math.isfinite(due)
    end = p["duration"]
    wait = due if meets else end
    ends = (
        -half + p["speed1"] * wait + after1 * (end - wait),
        half + p["speed2"] * wait + after2 * (end - wait),
    )
    kept_theory = _kinetic(p, after1, after2)
    rows = (
        Row("time of contact", met, "s", due, "(distance - 2 r) / (v₁ - v₂)"),
        Row(
            "centres apart at contact", _apart(met, record.t, x, v), "m", 2 * r if meets else math.nan, "2 r"
        ),
        Row("velocity of 1 afterwards", float(v[-1, 0]), "m/s", after1, "momentum and restitution"),
        Row("velocity of 2 afterwards", float(v[-1, 1]), "m/s", after2, "momentum and restitution"),
        Row(f"position of 1 at {end:g} s", float(x[-1, 0]), "m", ends[0], "straight lines"),
        Row(f"position of 2 at {end:g} s", float(x[-1, 1]), "m", ends[1], "straight lines"),
        Row(
            "total momentum at the end", float(momentum[-1]), "kg m/s", float(momentum[0]), "as at the start"
        ),
        Row("kinetic energy at the end", float(energy[-1]), "J", kept_theory, "what restitution leaves"),
    )
    return Result(
        simulation="collision",
        settings=p,
        rows=rows,
        headline=_headline(met, float(energy[0]), float(energy[-1])),
        finding=_finding(p, met, float(energy[0]), float(energy[-1])),
        columns=(
            Column.of("t", "s", record.t),
            Column.of("x1", "m", x[:, 0]),
            Column.of("x2", "m", x[:, 1]),
            Column.of("v1", "m/s", v[:, 0]),
            Column.of("v2", "m/s", v[:, 1]),
            Column.of("momentum", "kg m/s", momentum),
            Column.of("kinetic_energy", "J", energy),
        ),
    )


def _theory(p: Mapping[str, Any]) -> tuple[float, float, float]:
    """Time of contact (NaN if there is none) and the velocities at the end."""
    v1, v2 = p["speed1"], p["speed2"]
    closing = v1 - v2
    room = p["distance"] - 2 * p["radius"]
    if closing <= 0 or room / closing > p["duration"]:
        return math.nan, v1, v2
    impulse = (1 + p["restitution"]) * closing / (1 / p["mass1"] + 1 / p["mass2"])
    return room / closing, v1 - impulse / p["mass1"], v2 + impulse / p["mass2"]


def _kinetic(p: Mapping[str, Any], v1: float, v2: float) -> float:
    return float(0.5 * p["mass1"] * v1**2 + 0.5 * p["mass2"] * v2**2)


def _apart(met: float, t: np.ndarray, x: np.ndarray, v: np.ndarray) -> float:
    """Distance of the centres at the moment of contact, carried on from the sample before it."""
    if math.isnan(met):
        return math.nan
    i = max(int(np.searchsorted(t, met, side="left")) - 1, 0)
    places = x[i] + v[i] * (met - t[i])
    return float(places[1] - places[0])


def _headline(met: float, before: float, after: float) -> str:
    if math.isnan(met):
        return "The two balls never touch, and their motion does not change"
    kept = "all" if abs(after - before) <= 1e-9 * before else percent(after / before)
    return f"Contact at {met:.4g} s conserves momentum and {kept} of the kinetic energy"


def _finding(p: Mapping[str, Any], met: float, before: float, after: float) -> str:
    if math.isnan(met):
        return f"Within {p['duration']:g} s the two do not touch; momentum and energy do not change."
    centres = p["distance"] / (p["speed1"] - p["speed2"])
    kept = "all of the kinetic energy" if abs(after - before) <= 1e-9 * before else (
        f"{percent(after / before)} of the kinetic energy; the rest becomes heat"
    )  # fmt: skip
    passing = (
        f" Points without size would have passed through each other at {centres:.4g} s."
        if p["radius"] > 0
        else ""
    )
    return (
        f"The surfaces touch at {met:.4g} s, when the centres are still {2 * p['radius']:g} m apart."
        f"{passing} "
        f"The impact conserves momentum, whatever the restitution, and {kept}."
    )


SIMULATION = Simulation(
    id="collision",
    title="A collision: when do they touch, and what is conserved?",
    question="Two balls of radius 0.5 m, 10 m apart, approach at 2 m/s each. When do they touch, and where "
    "are they after 5 s?",
    teaches="model: contact",
    parameters=(
        Parameter("mass1", 1.0, "kg", "of the left ball", low=1e-3, high=1e6),
        Parameter("mass2", 1.0, "kg", "of the right ball", low=1e-3, high=1e6),
        Parameter("speed1", 2.0, "m/s", "of the left ball, to the right", low=-1000.0, high=1000.0),
        Parameter(
            "speed2", -2.0, "m/s", "of the right ball; negative is to the left", low=-1000.0, high=1000.0
        ),
        Parameter("distance", 10.0, "m", "between the centres at the start", low=0.0, high=1e5, above=True),
        Parameter("radius", 0.5, "m", "of both balls", low=0.0, high=1e4),
        Parameter("restitution", 1.0, "1", "speed after over speed before", low=0.0, high=1.0),
        duration(5.0),
        step(),
    ),
    run=_run,
)

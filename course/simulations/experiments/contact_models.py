"""One ball, one floor, and what the contact models of engines make of them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.contact.models import Constraint, Penalty, SoftConvex, drop, erp_cfm
from course.simulations.base import Column, Parameter, Result, Row, Simulation, step
from course.simulations.words import digits, percent

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from course.physics.contact.models import ContactModel

    Array = NDArray[np.float64]

__all__ = ["SIMULATION"]

_PHASES = 40  # starts that differ by parts of a step, each in the middle of its part


def _run(p: Mapping[str, Any]) -> Result:
    h, g, e, erp = p["step"], p["gravity"], p["restitution"], p["erp"]
    phases = (np.arange(_PHASES) + 0.5) / _PHASES
    heights = p["height"] + phases * h * math.sqrt(2 * g * p["height"])
    models = _models(e, erp)
    rebound = {
        name: np.array([_rebound(model, z, h, g) / z for z in heights]) for name, model in models.items()
    }
    elastic = _models(1.0, erp)
    kept = {
        name: np.array([_rebound(model, z, h, g) / z for z in heights]) for name, model in elastic.items()
    }
    rows = (*_at_rest(p), *_out_of_an_overlap(p), *_of_bounces(rebound, kept, e))
    low, high = float(rebound["none"].min()), float(rebound["none"].max())
    gained = float(kept["erp"].mean()) - 1
    return Result(
        simulation="contact-models",
        settings=p,
        rows=rows,
        headline=f"With e = {e:g} a ball rises to {low:.3f} to {high:.3f} of its height, not to {e**2:.3f}",
        finding=f"With a floor that looks once a step of {h:g} s the ball rises to between {digits(low)} and "
        f"{digits(high)} of its height, depending on when in the step it arrives; theory says "
        f"{digits(e**2)}. Correction with an ERP of {erp:g} in the velocity changes the energy of an elastic "
        f"ball by {percent(gained)} a bounce on average; as split impulse it does not change the velocity.",
        columns=(
            Column.of("phase", "1", phases),
            *(Column.of(f"rebound_{name}", "1", values) for name, values in rebound.items()),
            *(Column.of(f"kept_{name}", "1", values) for name, values in kept.items()),
        ),
    )


def _models(e: float, erp: float) -> dict[str, Constraint]:
    return {
        "none": Constraint(e),
        "erp": Constraint(e, erp=erp),
        "split": Constraint(e, erp=erp, split=True),
    }


def _at_rest(p: Mapping[str, Any]) -> tuple[Row, ...]:
    """How deep a ball of 1 kg lies in the floor after a second, m."""
    h, g, k = p["step"], p["gravity"], p["stiffness"]
    damping = math.sqrt(k)  # half the critical one
    erp, cfm = erp_cfm(k, damping, h)
    soft = SoftConvex(timeconst=max(0.02, 2 * h))  # MuJoCo's default, which it does not let fall below 2 h
    models: tuple[tuple[str, ContactModel, float, str], ...] = (
        ("constraint", Constraint(), 0.0, "it may not enter"),
        ("ERP and CFM of the spring", Constraint(erp=erp, cfm=cfm), g / k, "m g / k"),
        ("soft convex", soft, soft.resting_depth(g), "(1 - d) g = d k depth"),
        ("penalty", Penalty(k, damping), g / k, "m g / k"),
    )
    rows = []
    for name, model, theory, source in models:
        gaps = drop(model, 0.0, 0.0, h, math.ceil(1.0 / h), g)[0]
        thrown = not np.all(np.abs(gaps) < 1.0)  # more than a metre: the spring was too stiff for the step
        deep = math.nan if thrown else -float(gaps[-1])
        rows.append(Row(f"depth at rest, {name}", deep, "m", theory, source))
    return tuple(rows)


def _out_of_an_overlap(p: Mapping[str, Any]) -> tuple[Row, ...]:
    """How high a ball that begins inside the floor is thrown by the correction, m."""
    h, g = p["step"], p["gravity"]
    rows = []
    for name, split in (("in the velocity", False), ("split impulse", True)):
        gaps, _ = drop(Constraint(erp=p["erp"], split=split), -p["overlap"], 0.0, h, math.ceil(1.0 / h), g)
        hop = max(0.0, float(gaps.max()))
        rows.append(Row(f"hop out of the overlap, ERP {name}", hop, "m", 0.0, "nothing pushed it"))
    return tuple(rows)


def _of_bounces(rebound: Mapping[str, Array], kept: Mapping[str, Array], e: float) -> tuple[Row, ...]:
    words = {"none": "no correction", "erp": "ERP in the velocity", "split": "split impulse"}
    rows = []
    for name, values in rebound.items():
        for which, value in (("lowest", values.min()), ("highest", values.max())):
            rows.append(Row(f"{which} rebound, {words[name]}", float(value), "1", e**2, "e²"))
    for name, values in kept.items():
        rows.append(Row(f"energy kept at e = 1, {words[name]}", float(values.mean()), "1", 1.0, "conserved"))
    return tuple(rows)


def _rebound(model: ContactModel, height: float, h: float, g: float) -> float:
    """Top of the first bounce, m: the highest sample between the first that rises and the next that falls."""
    # Down takes one fall; up again another, or two more where a correction doubles the speed.
    gaps, speeds = drop(model, height, 0.0, h, math.ceil(3.5 * math.sqrt(2 * height / g) / h) + 2, g)
    rising = speeds > 0
    first = int(np.argmax(rising))
    falls = np.flatnonzero(~rising[first:])
    return float(gaps[first : first + falls[0] + 1].max()) if rising.any() and falls.size else 0.0


SIMULATION = Simulation(
    id="contact-models",
    title="Contact models: what is a floor made of?",
    question="A ball of 1 kg lies on a floor, bounces on it, or starts a little inside it. Which contact "
    "model lets it sink, which lets it hop, and which gives it energy?",
    teaches="model: contact",
    parameters=(
        Parameter("height", 1.0, "m", "that the ball is dropped from", low=0.01, high=100.0),
        Parameter("restitution", 0.5, "1", "speed after over speed before", low=0.0, high=1.0),
        Parameter("erp", 0.2, "1", "share of an overlap that a step removes", low=0.0, high=1.0),
        Parameter("overlap", 0.02, "m", "of the ball that starts inside the floor", low=0.0, high=1.0),
        Parameter("stiffness", 1e4, "N/m", "of the spring under a ball of 1 kg", low=1.0, high=1e9),
        Parameter("gravity", 9.81, "m/s²", "acceleration downwards", low=0.1, high=100.0),
        step(high=0.05),
    ),
    run=_run,
)

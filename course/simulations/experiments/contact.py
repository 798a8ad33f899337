"""Contact: a collision, the models of a floor, a stack of boxes and substeps."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.contact.models import Constraint, ContactModel, Penalty, SoftConvex, drop, erp_cfm
from course.physics.simulator import Simulator, step_count
from course.physics.solver import Chain, iterations_to, stack_impulses
from course.physics.state import Array, RigidBodyState
from course.printable import counted
from course.simulations.base import (
    Column,
    Parameter,
    Result,
    Row,
    Simulation,
    digits,
    duration,
    percent,
    step,
)

# ---
# Two balls meet head on: when, how fast do they part, and what is kept?


def _run_collision(p: Mapping[str, Any]) -> Result:
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
    left = end - wait
    ends = (-half + p["speed1"] * wait + after1 * left, half + p["speed2"] * wait + after2 * left)
    kept_theory = float(0.5 * p["mass1"] * after1**2 + 0.5 * p["mass2"] * after2**2)
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
    headline = f"Within {end:g} s the two balls do not touch; their motion does not change"
    if not math.isnan(met):
        kept = _kept(float(energy[0]), float(energy[-1]))
        headline = f"Contact at {met:.4g} s conserves momentum and {kept} of the kinetic energy"
    return Result(
        rows=rows,
        headline=headline,
        finding=_finding_collision(p, met, float(energy[0]), float(energy[-1])),
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


def _apart(met: float, t: np.ndarray, x: np.ndarray, v: np.ndarray) -> float:
    """Distance of the centres at the moment of contact, carried on from the sample before it."""
    if math.isnan(met):
        return math.nan
    i = max(int(np.searchsorted(t, met, side="left")) - 1, 0)
    places = x[i] + v[i] * (met - t[i])
    return float(places[1] - places[0])


def _kept(before: float, after: float) -> str:
    if abs(after - before) <= 1e-9 * before:
        return "all"
    share = percent(after / before)
    return "none" if after <= 1e-9 * before else "nearly all" if share == "100 %" else share


def _finding_collision(p: Mapping[str, Any], met: float, before: float, after: float) -> str:
    if math.isnan(met):
        return f"Within {p['duration']:g} s the two do not touch; momentum and energy do not change."
    centres = p["distance"] / (p["speed1"] - p["speed2"])
    kept = _kept(before, after)
    heat = {"all": "", "none": ", which becomes heat"}.get(kept, "; the rest becomes heat")
    passing = f" Points without size would have passed through each other at {centres:.4g} s."
    return (
        f"The surfaces touch at {met:.4g} s, when the centres are still {2 * p['radius']:g} m apart."
        f"{passing * (p['radius'] > 0)} The impact conserves momentum, whatever the restitution, and {kept} "
        f"of the kinetic energy{heat}."
    )


COLLISION = Simulation(
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
    run=_run_collision,
)


# ---
# One ball, one floor, and what the contact models of engines make of them.


_PHASES = 40  # starts that differ by parts of a step, each in the middle of its part


def _run_contact_models(p: Mapping[str, Any]) -> Result:
    h, g, e, erp = p["step"], p["gravity"], p["restitution"], p["erp"]
    phases = (np.arange(_PHASES) + 0.5) / _PHASES
    rebound, kept = (
        {
            "none": rebounds(Constraint(each), p["height"], phases, h, g),
            "erp": rebounds(Constraint(each, erp=erp), p["height"], phases, h, g),
            "split": rebounds(Constraint(each, erp=erp, split=True), p["height"], phases, h, g),
        }
        for each in (e, 1.0)
    )
    thrown = _out_of_an_overlap(p)
    rows = (*_at_rest(p), *thrown, *_of_bounces(rebound, kept, e))
    hops = f"hops {thrown[0].simulated:.3g} m high" if thrown[0].simulated > 1e-9 else "does not hop"
    if erp * p["overlap"]:
        hops += ", and with a smaller step higher" if "high" in hops else ", but would with a smaller step"
    low, high = float(rebound["none"].min()), float(rebound["none"].max())
    gained = float(kept["erp"].mean()) - 1
    rises = f"{low:.3f} to {high:.3f} of its height, not to {e**2:.3f}"
    spread = f"between {digits(low)} and {digits(high)} of its height, depending on when in the step it "
    spread += f"arrives; theory says {digits(e**2)}"
    if f"{low:.3f}" == f"{high:.3f}" == f"{e**2:.3f}":
        rises = spread = f"{e**2:.3f} of its height, as theory says"
    corrected = (
        f"Correction with an ERP of {erp:g} in the velocity changes the energy of an elastic ball by "
        f"{percent(gained)} a bounce on average; as split impulse it does not change the velocity. With the "
        f"first, a ball that starts {p['overlap']:g} m inside the floor {hops}."
    )
    return Result(
        rows=rows,
        headline=f"With e = {e:g} a ball rises to {rises}",
        finding=f"With a floor that looks once a step of {h:g} s the ball rises to {spread}. "
        + (corrected if erp else "An ERP of 0 corrects nothing."),
        columns=(
            Column.of("phase", "1", phases),
            *(Column.of(f"rebound_{name}", "1", values) for name, values in rebound.items()),
            *(Column.of(f"kept_{name}", "1", values) for name, values in kept.items()),
        ),
    )


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
    found = []
    for name, split in (("in the velocity", False), ("split impulse", True)):
        gaps, _ = drop(Constraint(erp=p["erp"], split=split), -p["overlap"], 0.0, h, math.ceil(1.0 / h), g)
        hop = max(0.0, float(np.max(gaps)))
        found.append(Row(f"hop out of the overlap, ERP {name}", hop, "m", 0.0, "nothing pushed it"))
    return tuple(found)


def _of_bounces(rebound: Mapping[str, Array], kept: Mapping[str, Array], e: float) -> tuple[Row, ...]:
    words = {"none": "no correction", "erp": "ERP in the velocity", "split": "split impulse"}
    rows = []
    for name, values in rebound.items():
        for which, value in (("lowest", np.min(values)), ("highest", np.max(values))):
            rows.append(Row(f"{which} rebound, {words[name]}", float(value), "1", e**2, "e²"))
    for name, values in kept.items():
        rows.append(Row(f"energy kept at e = 1, {words[name]}", float(values.mean()), "1", 1.0, "conserved"))
    return tuple(rows)


def rebounds(model: ContactModel, height: float, phases: Array, h: float, g: float) -> Array:
    """First rebounds of a ball that falls from ``height`` (m) and parts of a step more, as shares of that."""
    heights = height + phases * h * math.sqrt(2 * g * height)
    return np.array([_rebound(model, z, h, g) / z for z in heights])


def _rebound(model: ContactModel, height: float, h: float, g: float) -> float:
    """Top of the first bounce, m: the highest sample between the first that rises and the next that falls."""
    # Down takes one fall; up again another, or two more where a correction doubles the speed.
    gaps, speeds = drop(model, height, 0.0, h, math.ceil(3.5 * math.sqrt(2 * height / g) / h) + 2, g)
    rising = speeds > 0
    first = int(np.argmax(rising))
    falls = np.flatnonzero(~rising[first:])
    return float(np.max(gaps[first : first + falls[0] + 1])) if rising.any() and falls.size else 0.0


CONTACT_MODELS = Simulation(
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
    run=_run_contact_models,
)


# ---
# A stack of boxes and a solver that goes over its contacts one by one: how often must it go?


_STACKS = (2, 5, 10, 20)
_CHAIN_ITERATIONS = (4, 16, 64)


def _run_solver_iterations(p: Mapping[str, Any]) -> Result:
    boxes, tolerance, last = p["boxes"], p["tolerance"], p["iterations"]
    heights = tuple(sorted({*_STACKS, boxes}))
    needed = {count: iterations_to(count, tolerance) for count in heights}
    histories = {count: stack_impulses(count, last)[:, 0] / count for count in heights}
    rows = [Row(f"iterations to {percent(tolerance)}, {n} boxes", k, "1") for n, k in needed.items()]
    rows += [
        Row(f"error left per iteration, {n} boxes", _rate(n), "1", math.cos(math.pi / (2 * n)) ** 2,
            "cos²(π / (2 n))")
        for n in heights
    ]  # fmt: skip
    chain = {k: float(np.max(Chain().stretch(2.0, 1 / 60, 1, k))) for k in _CHAIN_ITERATIONS}
    rows += [Row(f"20-link chain, stretch after {k} iterations a frame", s, "1", 0.0, "stiff links")
             for k, s in chain.items()]  # fmt: skip
    done = float(histories[boxes][-1])
    tall, short = heights[-1], heights[0]
    return Result(
        rows=tuple(rows),
        headline=f"{tall} boxes need {needed[tall]} iterations to reach {percent(tolerance)}, "
        f"{short} need {needed[short]}",
        finding=f"After {counted(last, 'iteration')} from zero the ground carries {percent(done)} of the "
        f"weight of {boxes} boxes. To come within {percent(tolerance)} takes "
        f"{counted(needed[boxes], 'iteration')}, and the number grows with the square of the "
        "height, because a change spreads from contact to contact as heat does: twice as far takes four "
        "times as many. "
        "Engines start from the answer of the last step instead, so a stack that stands still stays up.",
        columns=(
            Column.of("iteration", "1", np.arange(last + 1)),
            *(Column.of(f"load_{n}_boxes", "1", history) for n, history in histories.items()),
        ),
    )


def _rate(boxes: int) -> float:
    """By which factor the error of the lowest impulse shrinks per iteration, once it shrinks evenly."""
    start = 2 * boxes * boxes
    errors = boxes - stack_impulses(boxes, start + 1)[:, 0]
    # Round-off drowns the ratio when little is left; step back to where there is enough.
    good = int(np.flatnonzero(errors > 1e-9 * boxes)[-1])
    return float(errors[good] / errors[good - 1])


SOLVER_ITERATIONS = Simulation(
    id="solver-iterations",
    title="Solver: how many iterations does a stack need?",
    question="Two boxes need 7 iterations before the ground carries their weight to 1 %. How many do twenty "
    "need: 70, 200, 700?",
    teaches="solver parameters",
    parameters=(
        Parameter("boxes", 20, "1", "height of the stack", low=2, high=60),
        Parameter("tolerance", 0.01, "1", "error that is allowed, a share", low=1e-4, high=0.5),
        Parameter("iterations", 800, "1", "how many to show", low=1, high=20_000),
    ),
    run=_run_solver_iterations,
)


# ---
# The same work spent in two ways: many iterations of one step, or one iteration of many small steps.


def _run_substeps(p: Mapping[str, Any]) -> Result:
    chain = Chain(links=p["links"], length=p["length"])
    h, work = p["frame"], p["work"]
    n = step_count(p["duration"], h)
    if n * work * p["links"] > 2_000_000:
        raise ValueError(
            f"{n:,} frames of {work} iterations over {p['links']} links take too long; reduce one of them."
        )
    splits = [(k, work // k) for k in range(1, work + 1) if work % k == 0]
    if len(splits) > 6:
        splits = [splits[round(i * (len(splits) - 1) / 5)] for i in range(6)]
    series = {split: chain.stretch(p["duration"], h, *split) for split in splits}
    worst = {split: float(np.max(values)) for split, values in series.items()}
    rows = tuple(
        Row(f"greatest stretch, {_words(*split)}", stretch, "1", 0.0, "stiff links")
        for split, stretch in worst.items()
    )
    one, many = worst[splits[0]], worst[splits[-1]]
    names, less, more = ("small steps", "iterations"), many, one
    why = "a small step makes a small error, and the next step starts after it has been corrected."
    if many > one:
        names, less, more = ("iterations", "small steps"), one, many
        why = "for so few links the iterations of one step are enough."
    better = f"{more / less:.2g} times" if less > 0 else "far"
    return Result(
        rows=rows,
        headline=f"Same work: {names[0]} stretch the chain {better} less than {names[1]} do",
        finding=f"Every variant goes over the chain {work} times a frame. One step with {work} iterations "
        f"lets a link stretch by {digits(one, 2)} of its length, {work} steps with one iteration by "
        f"{digits(many, 2)}: {why}",
        columns=(
            Column.of("t", "s", h * np.arange(n + 1)),
            *(Column.of(f"stretch_{s}x{i}", "1", values) for (s, i), values in series.items()),
        ),
    )


def _words(steps: int, iterations: int) -> str:
    return f"{counted(steps, 'substep')} x {counted(iterations, 'iteration')}"


SUBSTEPS = Simulation(
    id="substeps",
    title="Substeps: where to spend the work",
    question="A solver makes 16 iterations a frame: in one step, or in 16 steps with one each. With which "
    "does the chain stretch less, and by how much?",
    teaches="solver parameters; time step",
    parameters=(
        Parameter("links", 20, "1", "links of the chain", low=2, high=100),
        Parameter("length", 2.0, "m", "of the whole chain", low=0.01, high=100.0),
        Parameter("work", 16, "1", "iterations over the chain a frame", low=2, high=64),
        Parameter("frame", 1 / 60, "s", "time between frames", low=1e-3, high=0.1),
        Parameter(
            "duration", 2.0, "s", "how long to simulate; a whole number of frames", low=1e-3, high=60.0
        ),
    ),
    run=_run_substeps,
)

"""Motion under forces: an arm, chaos, the floor and the methods of integration."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.dynamics import DrivenArm, HandPath, PassiveArm, TwoLinkArm
from course.physics.integrators import RK4, STEPPERS, SemiImplicitEuler, State, trajectory
from course.physics.invariants import energy, relative_change
from course.physics.simulator import Simulator, step_count
from course.physics.state import Array, RigidBodyState
from course.physics.systems import Oscillator
from course.printable import counted
from course.simulations.base import (
    METHOD_NAMES,
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
# An arm of two links: plan a path (kinematics), find the torques (inverse), let them act (forward).


def _run_dynamics(p: Mapping[str, Any]) -> Result:
    arm = TwoLinkArm()
    if (p["start_x"], p["start_y"]) == (p["end_x"], p["end_y"]):
        raise ValueError("the hand starts where it should end; set another start or end.")
    path = HandPath((p["start_x"], p["start_y"]), (p["end_x"], p["end_y"]), p["duration"])
    h = p["step"]
    n = step_count(p["duration"], h)
    t = h * np.arange(n + 1)
    planned, rates, accelerations = path.joints(arm, t)
    torques = arm.inverse(planned, rates, accelerations)
    real = arm.carrying(p["payload"])
    run = trajectory(RK4(), DrivenArm(real, arm, path), State.of(planned[0], rates[0]), h, n)
    _refuse_runaway(h, run.q, run.v)
    back = arm.inverse(planned, rates, arm.forward(planned, rates, torques))
    missed = float(np.linalg.norm(real.hand(run.q[-1]) - np.asarray(path.end)))
    rows = (
        *_kinematic_rows(p, arm, path, planned),
        *_inverse_rows(arm, planned[0], torques),
        Row("inverse(forward(torque)) - torque, at most", float(np.max(np.abs(back - torques))), "N m", 0.0,
            "the two undo each other"),
        Row("hand off its goal after the forward run", missed, "m", 0.0, "same arm, same torques"),
        _work_row(real, run.q, run.v, torques, t),
    )  # fmt: skip
    hand, goal = real.hand(run.q), path.hand(t)[0]
    return Result(
        rows=rows,
        headline=_headline_dynamics(p, missed),
        finding=_finding_dynamics(p, missed, torques),
        columns=(
            Column.of("t", "s", t),
            *(Column.of(f"q{k + 1}_planned", "rad", planned[:, k]) for k in (0, 1)),
            *(Column.of(f"torque{k + 1}", "N m", torques[:, k]) for k in (0, 1)),
            *(Column.of(f"q{k + 1}", "rad", run.q[:, k]) for k in (0, 1)),
            *(Column.of(f"hand_{axis}", "m", hand[:, k]) for k, axis in enumerate("xy")),
            *(Column.of(f"planned_{axis}", "m", goal[:, k]) for k, axis in enumerate("xy")),
        ),
    )


def _refuse_runaway(h: float, *values: ArrayLike) -> None:
    if not all(np.all(np.isfinite(value)) for value in values):
        raise ValueError(
            f"with a step of {h:g} s the motion runs away beyond all numbers; take a smaller step."
        )


def _kinematic_rows(p: Mapping[str, Any], arm: TwoLinkArm, path: HandPath, planned: Array) -> tuple[Row, Row]:
    hand = arm.hand(planned)
    line = np.subtract(path.end, path.start)
    length = float(np.linalg.norm(line))
    aside = np.abs((hand - path.start) @ np.array([-line[1], line[0]])) / length
    # The joints decide, not the formula: differences of the hand they make.
    fastest = float(np.max(np.linalg.norm(np.diff(hand, axis=0), axis=-1))) / p["step"]
    due = 1.875 * length / p["duration"]
    return (
        Row("kinematic: hand off the straight line, at most", float(aside.max()), "m", 0.0, "the plan"),
        Row("kinematic: greatest speed of the hand", fastest, "m/s", due, "15/8 d / T"),
    )


def _inverse_rows(arm: TwoLinkArm, q: Array, torques: Array) -> tuple[Row, Row]:
    """Torques that hold the arm at the start, against plain levers: weight times distance."""
    lever1 = arm.centre1 * np.cos(q[0])
    lever2 = arm.length1 * np.cos(q[0]) + arm.centre2 * np.cos(q[0] + q[1])
    shoulder = float(arm.g * (arm.mass1 * lever1 + arm.mass2 * lever2))
    elbow = float(arm.g * arm.mass2 * arm.centre2 * np.cos(q[0] + q[1]))
    first, second = torques[0].tolist()
    return (
        Row("inverse: shoulder torque at the start", first, "N m", shoulder, "weights times levers"),
        Row("inverse: elbow torque at the start", second, "N m", elbow, "weight times lever"),
    )


def _work_row(arm: TwoLinkArm, q: Array, v: Array, torques: Array, t: Array) -> Row:
    power = np.sum(torques * v, axis=-1)
    work = float(np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(t)))
    gained = float(arm.energy(q[-1], v[-1]) - arm.energy(q[0], v[0]))
    return Row("forward: energy gained", gained, "J", work, "work of the torques, by trapezes")


_CLOSE = 0.01  # m: the hand comes to its goal


def _headline_dynamics(p: Mapping[str, Any], missed: float) -> str:
    if p["payload"] > 0:
        return f"A load of {p['payload']:g} kg is not in the model: the hand misses by {missed:.2g} m"
    if missed > _CLOSE:
        return f"Plan and arm are the same, and still the hand misses by {missed:.2g} m"
    return "Torques from inverse dynamics carry the hand along the planned line"


def _finding_dynamics(p: Mapping[str, Any], missed: float, torques: Array) -> str:
    peak = np.max(np.abs(torques), axis=0)
    plan = (
        "Kinematics plans the joint angles of a straight line without any forces; inverse dynamics says "
        f"which torques that takes, up to {peak[0]:.3g} N m at the shoulder and {peak[1]:.3g} N m at the "
        "elbow; forward dynamics says what those torques do. "
    )
    if p["payload"] > 0:
        return (
            f"{plan}The real arm carries {p['payload']:g} kg that is not in the plan, and its hand "
            f"ends {missed:.2g} m from the goal. Torques are only as good as the model, and nothing here "
            "pulls the arm back. A controller would do that with feedback."
        )
    if missed > _CLOSE:
        return (
            f"{plan}The hand ends {missed:.2g} m from its goal, although plan and arm are the same model: "
            "the errors of the steps grow, and nothing here pulls the arm back."
        )
    return f"{plan}The hand ends {missed:.1e} m from its goal, because here plan and arm are the same model."


DYNAMICS = Simulation(
    id="dynamics",
    title="Forward, inverse and kinematic: one arm, three questions",
    question="The torques were computed for an arm of 2 kg with an empty hand. If it holds 10 g, how far "
    "from its goal does it end: a millimetre, a centimetre, more?",
    teaches="kinds of simulation; model complexity",
    parameters=(
        Parameter("start_x", 1.2, "m", "where the hand starts", low=-2.0, high=2.0),
        Parameter("start_y", -0.8, "m", "where the hand starts", low=-2.0, high=2.0),
        Parameter("end_x", 0.6, "m", "where the hand should end", low=-2.0, high=2.0),
        Parameter("end_y", 1.2, "m", "where the hand should end", low=-2.0, high=2.0),
        Parameter("payload", 0.0, "kg", "in the hand, not in the plan", low=0.0, high=10.0),
        duration(1.0, high=100.0),
        step(high=0.1),
    ),
    run=_run_dynamics,
)


# ---
# Two double pendulums a billionth of a radian apart: for how long do they agree?


_CROWD = 400  # pendulums whose average is compared between two steps
_SPREAD = 1e-3  # rad: how far apart they start
_SEED = 1
_FEWEST = 40  # steps
_PENDULUM = TwoLinkArm.double_pendulum()


def _run_chaos(p: Mapping[str, Any]) -> Result:
    h = p["step"]
    n = step_count(p["duration"], h)
    if n < _FEWEST:
        raise ValueError(
            f"{counted(n, 'step')} would be too few to see anything part; take {_FEWEST} or more."
        )
    first, second = math.radians(p["angle1_deg"]), math.radians(p["angle2_deg"])
    if not (first or second):
        raise ValueError("both rods hang straight down and do not swing; set angle1_deg or angle2_deg.")
    pair = np.array([[first, second], [first + p["nudge"], second]])
    t, q, v = swing(pair, h, n)
    apart = np.max(np.abs(from_hanging(q[:, 1]) - from_hanging(q[:, 0])), axis=-1)
    small, large = _first_above(t, apart, 1e-3), _first_above(t, apart, 1.0)
    drift = float(np.max(np.abs(relative_change(_PENDULUM.energy(q[:, 0], v[:, 0]) + _OFFSET))))
    coarse, fine = _crowd(first, second, h, n)
    _refuse_runaway(h, drift, coarse, fine)
    later = f"more than 1 rad after {digits(large)} s"
    if math.isnan(large):
        later = f"still close after {p['duration']:g} s"
    rows = (
        Row("separation passes 1e-3 rad", small, "s"),
        Row("separation passes 1 rad", large, "s"),
        Row("growth of the separation", _growth(t, apart, p["nudge"]), "1/s"),
        Row("energy error, at most", drift, "1", 0.0, "nothing drives or brakes"),
        Row(f"mean energy of the upper bob, {_CROWD} starts, step {4 * h:g} s", coarse, "J/kg"),
        Row(f"mean energy of the upper bob, {_CROWD} starts, step {2 * h:g} s", fine, "J/kg"),
    )
    return Result(
        rows=rows,
        headline=f"{p['nudge']:.1g} rad apart at the start, {later}",
        finding=_finding_chaos(p, small, large, coarse, fine),
        columns=(
            Column.of("t", "s", t),
            Column.of("separation", "rad", apart),
            *(Column.of(f"angle{k + 1}_{name}", "rad", from_hanging(q[:, i])[:, k])
              for i, name in enumerate(("a", "b")) for k in (0, 1)),
        ),
    )  # fmt: skip


#: Energy is counted from the lowest point, so that a share of it means something. In J.
_OFFSET = 3 * 9.81


def swing(hanging: Array, h: float, n: int) -> tuple[Array, Array, Array]:
    """Let go of double pendulums, all at once; n steps of h (s).

    Args:
        hanging: angles of both rods from the downward vertical, rad, shape (..., 2); an arm counts otherwise.

    Returns:
        Times (n + 1,) in s, and the joints of the arm and their rates, both (n + 1, ..., 2).
    """
    upper = hanging[..., 0] - math.pi / 2
    joints = np.stack([upper, hanging[..., 1] - hanging[..., 0]], axis=-1)
    return trajectory(RK4(), PassiveArm(_PENDULUM), State.at_rest(joints), h, n)


def from_hanging(q: Array) -> Array:
    """Angles of both rods from the downward vertical, rad."""
    return np.stack([q[..., 0] + math.pi / 2, q[..., 0] + q[..., 1] + math.pi / 2], axis=-1)


def _first_above(t: Array, values: Array, level: float) -> float:
    above = np.flatnonzero(values > level)
    return float(t[above[0]]) if above.size else math.nan


def _growth(t: Array, apart: Array, nudge: float) -> float:
    """Slope of the logarithm of the separation, from where it is ten times the nudge until it is 0.1 rad."""
    end = _first_above(t, apart, 0.1)
    fit = (apart > 10 * abs(nudge)) & (t < (end if math.isfinite(end) else math.inf))
    if np.count_nonzero(fit) < 5:
        return math.nan
    return float(np.polyfit(t[fit], np.log(apart[fit]), 1)[0])


def _crowd(first: float, second: float, h: float, n: int) -> tuple[float, float]:
    """Kinetic energy of the upper bob, averaged over many starts and the second half, at 4 h and at 2 h."""
    starts = np.array([first, second]) + _SPREAD * np.random.default_rng(_SEED).standard_normal((_CROWD, 2))
    means = []
    for longer in (4, 2):
        _, _, v = swing(starts, h * longer, n // longer)
        means.append(float(np.mean(0.5 * v[n // longer // 2 :, :, 0] ** 2)))
    return means[0], means[1]


def _finding_chaos(p: Mapping[str, Any], small: float, large: float, coarse: float, fine: float) -> str:
    if math.isnan(large):
        return (
            f"Within {p['duration']:g} s the two stay less than 1 rad apart. Started low they swing almost "
            "like springs, and may never come apart; start them higher, and from there run for longer."
        )
    early = f"after {digits(small)} s" if small > 0 else "at the start"
    return (
        f"A difference of {p['nudge']:.1g} rad passes 0.001 rad {early} and 1 rad after "
        f"{digits(large)} s. "
        "After that a comparison of two paths says nothing about a simulator, because an error in the last "
        f"digit grows like this too. Averages can still be compared: over {_CROWD} starts the energy of the "
        f"upper bob differs by {percent(abs(coarse / fine - 1))} between a step of {4 * p['step']:g} s and "
        "half of it."
    )


CHAOS = Simulation(
    id="chaos",
    title="Chaos: how long does a prediction last?",
    question="Two double pendulums start a billionth of a radian apart. After how many seconds can you see "
    "the difference?",
    teaches="limits of accuracy",
    parameters=(
        Parameter("angle1_deg", 160.0, "deg", "upper rod at the start, from hanging", low=-180.0, high=180.0),
        Parameter("angle2_deg", -95.0, "deg", "lower rod at the start, from hanging", low=-180.0, high=180.0),
        Parameter("nudge", 1e-9, "rad", "how much further the second upper rod starts", low=1e-12, high=1.0),
        duration(15.0, high=100.0),
        step(0.005, high=0.05),
    ),
    run=_run_chaos,
)


# ---
# The floor decides: friction and restitution swept, and how little of the outcome the step decides.


_RADIUS = 0.1  # m
_GUESS = 0.3  # the friction that is taken to be 10 % lower
#: The whole sweep, as friction of one experiment and restitution of the other.
_SWEEP = np.round(np.arange(0.05, 1.0001, 0.05), 2)


def _run_environment(p: Mapping[str, Any]) -> Result:
    stopping = _slide(p, _SWEEP)
    if stopping[_at(_GUESS)] == 0.0:
        raise ValueError(
            f"at {p['speed']:g} m/s the block stops within one step of {p['step']:g} s; take a smaller "
            "step or a higher speed."
        )
    rebound = _drop(p, _SWEEP)
    stops = p["speed"] ** 2 / (2 * _SWEEP * p["gravity"])
    rises = _SWEEP**2 * p["height"]
    rows = [
        Row(f"{what} {x:g}", float(found[_at(x)]), "m", float(theory[_at(x)]), source)
        for what, found, theory, source, shown in (
            ("sliding to rest, friction", stopping, stops, "v² / (2 μ g)", (0.1, 0.3, 0.6)),
            ("rebound, restitution", rebound, rises, "e² times the drop", (0.3, 0.5, 0.9)),
        )
        for x in shown
    ]
    guess = _at(_GUESS)
    wrong = float(_slide(p, np.array([0.9 * _GUESS]))[0]) / float(stopping[guess]) - 1
    numeric = abs(float(stopping[guess] / stops[guess]) - 1)
    advice = (
        "Measure the floor before you refine the step."
        if numeric < wrong
        else "Refine the step before you measure the floor."
    )
    rows.append(Row("sliding further, friction 10 % lower", wrong, "1", 1 / 0.9 - 1, "1 / 0.9 - 1"))
    return Result(
        rows=tuple(rows),
        headline=f"Friction 10 % off moves the stop by {percent(wrong)}; this step by {percent(numeric)}",
        finding=f"From {p['speed']:g} m/s a block slides {digits(float(stopping[_at(0.6)]))} m at a "
        f"friction of 0.6 and {digits(float(stopping[_at(0.1)]))} m at 0.1. If the true friction is 10 % "
        f"lower than the modelled one, the block ends {percent(wrong)} further away; the step of "
        f"{p['step']:g} s makes an error of "
        f"{percent(numeric)}. {advice}",
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
    slowest = p["speed"] / (float(np.min(friction)) * p["gravity"])
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


ENVIRONMENT = Simulation(
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
    run=_run_environment,
)


# ---
# One spring, four methods: where do they put it, and what do they do to its energy?


def _run_integrators(p: Mapping[str, Any]) -> Result:
    w, h = p["omega"], p["step"]
    n = step_count(p["duration"], h)
    t = h * np.arange(n + 1)
    exact = p["amplitude"] * np.cos(w * t) + p["speed"] / w * np.sin(w * t)
    spring, start = Oscillator(omega=w), State.of([p["amplitude"]], [p["speed"]])
    positions: dict[str, Array] = {}
    drifts: dict[str, Array] = {}
    for name, method in STEPPERS.items():
        path = trajectory(method, spring, start, h, n)
        positions[name] = np.nan_to_num(path.q[:, 0], nan=np.inf)
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
        rows=tuple(rows),
        headline="From h ω = 2 on even the symplectic methods blow up"
        if w * h >= 2.0 or worst["velocity_verlet"] > 1.0
        else "Explicit Euler's energy keeps growing; the symplectic methods' does not",
        finding=_finding_integrators(p, rows, worst),
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


def _finding_integrators(p: Mapping[str, Any], rows: list[Row], worst: Mapping[str, float]) -> str:
    z = p["omega"] * p["step"]
    off = [abs(row.error or 0.0) for row in rows[:4]]
    if z >= 2.0:
        return (
            f"Step times frequency is {z:.3g}, {'at' if z == 2.0 else 'beyond'} the limit of 2 for "
            "semi-implicit Euler and Verlet"
            f"{' and 2.83 for Runge-Kutta' if z > 2 * math.sqrt(2) else ''}: these results mean nothing. "
            f"Take a step below {2 / p['omega']:.3g} s."
        )
    return (
        f"At {p['duration']:g} s explicit Euler is off by {digits(off[0])} m and semi-implicit Euler by "
        f"{digits(off[1])} m: the same two lines in another order. Explicit Euler's energy grows with every "
        f"step, to {digits(1 + worst['explicit_euler'])} times the start; semi-implicit Euler and Verlet "
        f"stay within {percent(worst['semi_implicit_euler'])} and {percent(worst['velocity_verlet'])}, "
        f"however long the run, and Runge-Kutta, now at {percent(worst['rk4'])}, goes on losing a little."
    )


INTEGRATORS = Simulation(
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
    run=_run_integrators,
)

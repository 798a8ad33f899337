"""Free motion: a fall, a throw and a spin."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.integrators import STEPPERS, State, first_crossing, hermite, trajectory
from course.physics.rotation import ROTATION_STEPPERS, Spin, angular_momentum, kinetic_energy, rotate
from course.physics.simulator import Recording, Simulator, step_count
from course.physics.state import Array, RigidBodyState
from course.physics.systems import FreeFall
from course.simulations.base import (
    METHOD,
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
    times,
)

# ---
# A ball is let go: when does it land, and what does each method make of the simplest motion there is?


def _run_free_fall(p: Mapping[str, Any]) -> Result:
    height, speed, g, h = p["height"], p["speed"], p["gravity"], p["step"]
    ball = Body(1.0, RigidBodyState.of([0.0, 0.0, height], [0.0, 0.0, speed]))
    engine = Simulator([ball], h=h, gravity=g, surface=Surface(0.0), stepper=STEPPERS[p["method"]])
    record = engine.run(p["duration"])
    landed = float(record.ground_time[0])
    due = (speed + math.sqrt(speed**2 + 2 * g * height)) / g
    lands = due <= p["duration"]
    falls = {method: _fall(p, method) for method in STEPPERS}
    exact = np.where(record.t < due, height + speed * record.t - 0.5 * g * record.t**2, 0.0)
    rows = (
        Row("time to the ground", landed, "s", due if lands else math.nan, "(v₀ + √(v₀² + 2 g h₀)) / g"),
        *_without_ground(p, falls),
    )
    bias = 0.5 * g * h * p["duration"]
    still = f"still {'rising' if record.velocity[-1, 0, 2] > 0 else 'falling'}"
    when = (
        f"The ball reaches the ground after {digits(landed, 4)} s; theory says {digits(due, 4)} s."
        if math.isfinite(landed)
        else f"The ball is {still} after {p['duration']:g} s; it would land after {due:.4g} s."
    )
    start = f"Down after {digits(landed, 4)} s"
    if not math.isfinite(landed):
        start = f"{still.capitalize()} at {p['duration']:g} s"
    return Result(
        rows=rows,
        headline=f"{start}; the two Eulers miss by {digits(bias)} m, one each way",
        finding=f"{when} Under constant gravity Verlet and Runge-Kutta are exact. Semi-implicit Euler moves "
        f"with a velocity that is half a step ahead, so it is too low by g h t / 2, here {digits(bias)} "
        "m, and explicit Euler is too high by the same amount: the sign shows which velocity an engine moves "
        "a body with, the new one or the old.",
        columns=(
            Column.of("t", "s", record.t),
            Column.of("height", "m", record.position[:, 0, 2]),
            Column.of("height_theory", "m", exact),
            *(Column.of(f"error_{method}", "m", off) for method, (_, off) in falls.items()),
        ),
    )


def _fall(p: Mapping[str, Any], method: str) -> tuple[np.ndarray, np.ndarray]:
    """Heights of a fall that no ground stops, and how far they are off; shapes (n + 1,)."""
    start = State.of([p["height"]], [p["speed"]])
    n = step_count(p["duration"], p["step"])
    path = trajectory(STEPPERS[method], FreeFall(g=p["gravity"]), start, p["step"], n)
    exact = p["height"] + p["speed"] * path.t - 0.5 * p["gravity"] * path.t**2
    return path.q[:, 0], path.q[:, 0] - exact


def _without_ground(p: Mapping[str, Any], falls: Mapping[str, tuple[Array, Array]]) -> list[Row]:
    t = p["duration"]
    exact = p["height"] + p["speed"] * t - 0.5 * p["gravity"] * t**2
    rows = [
        Row(f"height at {t:g} s without ground, {METHOD_NAMES[m]}", float(heights[-1]), "m", exact,
            "h₀ + v₀ t - g t² / 2")
        for m, (heights, _) in falls.items()
    ]  # fmt: skip
    bias, theory = float(falls["semi_implicit_euler"][1][-1]), -0.5 * p["gravity"] * p["step"] * t
    return [*rows, Row("bias of semi-implicit Euler", bias, "m", theory, "-g h t / 2")]


FREE_FALL = Simulation(
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
    run=_run_free_fall,
)


# ---
# A stone is thrown: how high, how far, and what does leaving the air out of the model cost?


def _run_projectile(p: Mapping[str, Any]) -> Result:
    drag, fastest = p["drag"], math.hypot(p["speed_x"], p["speed_z"])
    if drag and (drag * fastest * p["step"] > 1 or math.sqrt(drag * p["gravity"]) * p["step"] > 1):
        raise ValueError("air takes more than the whole speed in one step; take a smaller step or less drag.")

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
        rows=rows,
        headline=_headline_projectile(p, rows),
        finding=_finding_projectile(p, rows),
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
    due = due if due <= p["duration"] else math.nan
    return (
        Row("time of the highest point", when, "s", due, "v_z / g"),
        Row("greatest height", top, "m", p["height"] + up * due / 2, "z₀ + v_z² / (2 g)"),
        Row("distance there", out, "m", p["speed_x"] * due, "v_x v_z / g"),
    )


def _landing_rows(p: Mapping[str, Any], record: Recording) -> tuple[Row, Row]:
    due = _flight_time(p)
    due = due if due <= p["duration"] else math.nan
    landed = float(record.ground_time[0])
    # A stone that is on the ground at the start stays there.
    far = float(record.position[-1, 0, 0]) if landed > 0 else landed
    return (
        Row("time of landing", landed, "s", due, "(v_z + √(v_z² + 2 g z₀)) / g"),
        Row("distance of landing", far, "m", p["speed_x"] * due, "v_x times that"),
    )


_FIRST_ORDER = ("explicit_euler", "semi_implicit_euler")


def _headline_projectile(p: Mapping[str, Any], rows: tuple[Row, ...]) -> str:
    top, far = rows[1].simulated, rows[4]
    if math.isnan(far.simulated):
        return f"Still in the air after {p['duration']:g} s"
    if rows[3].simulated == 0:
        return "It starts on the ground and does not leave it"
    if p["drag"] > 0 and far.theory and math.isfinite(far.theory):
        lost = percent(1 - far.simulated / far.theory)
        return f"Air takes {lost} of the range: the model matters, not the step"
    exact = p["drag"] == 0 and p["method"] not in _FIRST_ORDER
    start = f"Up to {top:.4g} m, down again" if p["speed_z"] > 0 else "Down"
    return f"{start} {far.simulated:.5g} m away{', as theory says' * exact}"


def _finding_projectile(p: Mapping[str, Any], rows: tuple[Row, ...]) -> str:
    apex, top, out, landed, far = rows
    if math.isnan(landed.simulated):
        return f"After {p['duration']:g} s it is still in the air; a longer duration lets it land."
    if landed.simulated == 0:
        return "It starts on the ground and does not leave it; set height or speed_z above 0."
    rises = f"rises to {top.simulated:.4g} m at {apex.simulated:.4g} s, {out.simulated:.5g} m out, and "
    flight = (
        f"It {rises if p['speed_z'] > 0 else ''}lands after {landed.simulated:.4g} s, "
        f"{far.simulated:.5g} m away."
    )
    if p["drag"] > 0:
        off = (far.theory or 0.0) - far.simulated
        how_far = f" and is {off:.3g} m off at the landing" if off and math.isfinite(off) else ""
        return (
            f"{flight} The theory beside it has no air{how_far}. No smaller step repairs that, because the "
            "air is missing in the model."
        )
    if p["method"] in _FIRST_ORDER:
        return f"{flight} The difference from theory is the error of this method; it shrinks with the step."
    return f"{flight} The samples are {p['step']:g} s apart; interpolation finds the moments between them."


PROJECTILE = Simulation(
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
    run=_run_projectile,
)


# ---
# A body spun about its middle axis: it turns over by itself, and a naive method invents energy.


_NAMES = {"explicit_euler": "explicit Euler", "rk4": "Runge-Kutta 4", "split": "split rotations"}


def _run_rotation(p: Mapping[str, Any]) -> Result:
    inertia = np.array([p["inertia1"], p["inertia2"], p["inertia3"]])
    state = RigidBodyState.of(np.zeros(3), angular_velocity=[p["nudge"], p["spin"], p["nudge"]])
    Body(1.0, state, inertia=inertia)  # refuses moments that no body has
    start = Spin(state.orientation, state.angular_velocity)
    if not start.angular_velocity.any():
        raise ValueError("a body that does not turn has no rotation to show; set spin or nudge.")
    n = step_count(p["duration"], p["step"])
    runs = {name: rotate(ROTATION_STEPPERS[name], inertia, start, p["step"], n) for name in _NAMES}
    # Explicit Euler may run away to infinity; that is its result.
    drifts = {
        name: np.nan_to_num(kinetic_energy(inertia, w) / kinetic_energy(inertia, w[0]) - 1.0, nan=np.inf)
        for name, (_, w) in runs.items()
    }
    w = runs["split"][1]
    t = p["step"] * np.arange(n + 1)
    flips = int(np.count_nonzero(np.diff(np.sign(w[w[:, 1] != 0, 1]))))
    momentum = angular_momentum(inertia, *runs["split"])
    lost = float(np.max(np.linalg.norm(momentum - momentum[0], axis=-1)) / np.linalg.norm(momentum[0]))
    rows = (
        *_energy_rows(drifts, {name: q for name, (q, _) in runs.items()}),
        Row("angular momentum lost, split rotations", lost, "1", 0.0, "no torque, share of it"),
        *_growth(p, inertia, t, w),
        Row("times it turned over", flips, "1"),
    )
    return Result(
        rows=rows,
        headline=_headline_rotation(p, flips, float(drifts["explicit_euler"][-1])),
        finding=_finding_rotation(p, flips, drifts),
        columns=(
            Column.of("t", "s", t),
            *(Column.of(f"w{k + 1}", "rad/s", w[:, k]) for k in range(3)),
            *(Column.of(f"energy_error_{name}", "1", drift) for name, drift in drifts.items()),
        ),
    )


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


def _headline_rotation(p: Mapping[str, Any], flips: int, gained: float) -> str:
    if abs(p["spin"]) * p["step"] > 0.5:
        return "The body turns too far in one step for these methods to follow"
    turns = f"The body flips over {times(flips)}" if flips else "The body never flips over"
    if gained > 10:
        return f"{turns}, and explicit Euler's energy explodes"
    return f"{turns}, and explicit Euler adds {percent(gained)} of energy"


def _about_axis_2(p: Mapping[str, Any], flips: int) -> str:
    moments = [p["inertia1"], p["inertia2"], p["inertia3"]]
    if p["spin"] == 0:
        return "The body does not spin about axis 2 at the start; set spin."
    if moments.count(p["inertia2"]) == 2:
        return "Axis 2 has the same moment as another axis: a wobble makes the spin drift to that one."
    if sorted(moments)[1] != p["inertia2"] or moments[0] == moments[1]:
        large = " Such a large wobble still turned the body over." if flips else ""
        return f"Axis 2 is not the middle one, and a spin about it is stable.{large}"
    if flips:
        over = f"the body flipped over {times(flips)}"
        return f"Axis 2 is the middle one, and a spin about it does not last: {over}."
    if p["nudge"] == 0:
        return "Axis 2 is the middle one, and nothing made the body wobble; set nudge."
    return "Axis 2 is the middle one, but the wobble has not yet had time to flip the body over."


def _finding_rotation(p: Mapping[str, Any], flips: int, drifts: Mapping[str, Array]) -> str:
    angle = abs(p["spin"]) * p["step"]
    if angle > 0.5:
        return (
            f"The body turns by {angle:.2g} rad in one step, too far for any of these methods to follow. "
            f"Take a step below {0.5 / abs(p['spin']):.2g} s."
        )
    gain = float(drifts["explicit_euler"][-1])
    gained = percent(gain) if math.isfinite(gain) else "energy without limit"
    return (
        f"{_about_axis_2(p, flips)} No torque acts, so the energy must not change: explicit Euler gains "
        f"{gained} in {p['duration']:g} s and stretches the quaternion, while split rotations stay within "
        f"{percent(float(np.max(np.abs(drifts['split']))))} and keep the angular momentum to round-off."
    )


ROTATION = Simulation(
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
    run=_run_rotation,
)

"""Small tests with known right answers, the same for every engine.

Each one builds its scenes, runs them and reduces the outcome to one number, to be compared with the right
one. A scene gives the friction and the restitution that must act; the adapter finds the values to set.
"""

import math
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

import numpy as np

from course.engines.base import Array, Body, EngineDivergedError, Motion, Scene, Wall, World, energy, momentum
from course.errors import NotFoundError
from course.physics import integrators as ode
from course.physics.systems import Pendulum
from course.printable import meant

Build = Callable[[Scene], World]


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of one scenario.

    Attributes:
        details: what else was seen, by name.
        samples: ``value`` is their mean or median: one for each phase of the step, or each start; empty
            where there is one run.
    """

    value: float
    details: dict[str, Any]
    samples: Sequence[float] = ()


# ---
# Scenarios without contact: errors there come from the integrator or a joint.


G = 9.81
#: 200 steps of 1/240 s.
FALL_S = 200.0 / 240.0
SWING_S = 2.0
DOUBLE_S = 10.0
#: The reference of the pendulum is computed with steps no longer than this, s; its error is below 1e-11 m.
_FINE_S = 1e-3
_BOB = 0.05
#: How often the energy of the double pendulum is looked at, s.
_LOOK_S = 1.0 / 30.0
#: Where the arms of the double pendulum start, degrees from hanging. More than one, since it is chaotic.
STARTS_DEG = (90.0, 92.0, 94.0, 96.0, 98.0)

#: A step is acceptable as long as the energy never changes by more than this, per cent.
KEPT_PERCENT = 10.0


def free_fall(build: Build, dt: float, quick: bool) -> Outcome:  # noqa: ARG001 - it is quick as it is
    """By how many per cent a body falls too far."""
    n = round(FALL_S / dt)
    scene = Scene((Body("ball", 0.1, 1.0, (0.0, 0.0, 0.0)),), dt=dt)
    world = build(scene)
    world.step(n)
    fallen = -world.motion().checked().x[0, 2]
    true = 0.5 * G * (n * dt) ** 2
    return Outcome(100.0 * (fallen / true - 1.0), {"steps": n, "fallen_m": float(fallen), "true_m": true})


def _bob(angle: float, top: tuple[float, float] = (0.0, 0.0)) -> Body:
    """A ball of 1 kg at the end of a rod of 1 m that hangs at ``angle`` (rad) from the vertical."""
    return Body("ball", _BOB, 1.0, (top[0] + math.sin(angle), 0.0, top[1] - math.cos(angle)))


def _path(n: int, dt: float) -> Array:
    """Where the bob of the pendulum should be at every step, (n + 1, 3), m."""
    bob = _bob(math.pi / 2)
    # About the hinge the ball turns with its own inertia too: theta'' = -g m L / (m L² + I) sin(theta).
    system = Pendulum(length=1.0 + bob.inertia / bob.mass, g=G)
    parts = max(1, math.ceil(dt / _FINE_S))
    start = ode.State.at_rest([math.pi / 2])
    run = ode.trajectory(ode.STEPPERS["rk4"], system, start, dt / parts, n * parts)
    angle = run.q[::parts, 0]
    return np.stack([np.sin(angle), 0.0 * angle, -np.cos(angle)], -1)


def pendulum(build: Build, dt: float, quick: bool) -> Outcome:  # noqa: ARG001
    """How far a swinging ball deviates from its true path, in per cent of the rod."""
    n = round(SWING_S / dt)
    scene = Scene((_bob(math.pi / 2),), pivots=((0.0, 0.0, 0.0),), dt=dt)
    world = build(scene)
    x = [scene.bodies[0].position]
    for _ in range(n):
        world.step()
        x.append(tuple(world.motion().checked().x[0]))
    off = np.linalg.norm(np.array(x) - _path(n, dt), axis=1)
    left = energy(scene, world.motion()) + G  # J, above that of hanging; it started with G
    changed = 100.0 * (left / G - 1.0)
    return Outcome(100.0 * float(np.max(off)), {"steps": n, "energy_change_percent": changed})


def double_pendulum(build: Build, dt: float, quick: bool) -> Outcome:
    """The largest change of energy within ten seconds, per cent; the median over five starts (quick: three).

    The change at the end would depend on the phase of the swing at that moment, even in its sign.
    """
    starts = STARTS_DEG[:3] if quick else STARTS_DEG
    runs = [_energy_change(build, dt, math.radians(degrees)) for degrees in starts]
    largest, last = zip(*runs, strict=True)
    details = {"starts_deg": list(starts), "largest_percent": list(largest), "at_the_end_percent": list(last)}
    return Outcome(statistics.median(largest), details, largest)


def long_step(build: Build, dt: float, quick: bool) -> Outcome:
    """The longest step with which the double pendulum keeps its energy to 10 % for ten seconds, ms.

    Steps of 1, 2, 4, 8 and 16 times ``dt`` are tried, up to the first that fails. A run that ends in a value
    that is not a number has failed. The start with the shortest step counts.
    """
    starts = STARTS_DEG[:3] if quick else STARTS_DEG
    samples = [1000.0 * _longest(build, dt, math.radians(degrees)) for degrees in starts]
    return Outcome(min(samples), {"starts_deg": list(starts), "longest_tried_ms": 16e3 * dt}, samples)


def _longest(build: Build, dt: float, angle: float) -> float:
    borne = 0.0
    for factor in (1, 2, 4, 8, 16):
        try:
            largest, _ = _energy_change(build, factor * dt, angle)
        except EngineDivergedError:
            break
        if largest > KEPT_PERCENT:
            break
        borne = factor * dt
    return borne


def _energy_change(build: Build, dt: float, angle: float) -> tuple[float, float]:
    """The largest change, regardless of sign, and the one at the end; per cent of what there was."""
    upper = _bob(angle)
    elbow = (upper.position[0], upper.position[2])
    lower = _bob(angle, top=elbow)
    scene = Scene((upper, lower), pivots=((0.0, 0.0, 0.0), upper.position), dt=dt)
    world = build(scene)
    hanging = -G * (1.0 + 2.0)
    before = energy(scene, world.motion()) - hanging
    n, each = round(DOUBLE_S / dt), max(1, round(_LOOK_S / dt))
    largest = change = 0.0
    for done in range(0, n, each):
        world.step(min(each, n - done))
        change = 100.0 * ((energy(scene, world.motion().checked()) - hanging) / before - 1.0)
        largest = max(largest, abs(change))
    return largest, change


# ---
# Scenarios with contact: restitution, friction, stacks and walls.


#: An impact is met at this many phases of a step (quick: a quarter of them), in the middles of as many equal
#: parts of it. When within a step a body arrives decides how deep the overlap is, and with it the impact in
#: many engines: a saw tooth, of whose mean the beginnings of the parts are off by half a part.
PHASES = 64
#: Of the balls at the thin wall, m/s.
SPEEDS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 400.0)
#: A pile is set up so often (quick: about half as often), with offsets of so many metres more each time, and
#: gaps from an overlap to some air; never none, which rounding would decide. They are less than is shown, and
#: yet decide in some engines whether it stands.
STARTS, _OFFSET_M = 5, 1e-6
_WORST = {"momentum_error_kg_m_s": max, "lowest_m": min, "contacts": min, "deepest_overlap_mm": max}
#: A push is raised until the box is faster than this within half a second, m/s.
_SLIPS = 0.01


def _phases(dt: float, quick: bool) -> Iterator[float]:
    """By how much earlier or later a body arrives, s."""
    count = PHASES // 4 if quick else PHASES
    return (dt * (k + 0.5) / count for k in range(count))


def _one_of(middle: Callable[[list[float]], float], runs: list[Outcome]) -> Outcome:
    """Several runs as one: the middle of their values, and each; of details the worst, or the first run's."""
    samples = [run.value for run in runs]
    worst = {
        name: _WORST[name](run.details[name] for run in runs) if name in _WORST else first
        for name, first in runs[0].details.items()
    }
    return Outcome(middle(samples), worst, samples)


def clash(build: Build, dt: float, quick: bool) -> Outcome:
    """By how many per cent an elastic collision changes the kinetic energy; the mean over phases."""
    return _one_of(statistics.fmean, [_clash(build, dt, late) for late in _phases(dt, quick)])


def _clash(build: Build, dt: float, late: float) -> Outcome:
    light = Body("ball", 0.1, 1.0, (-0.5 - late, 0.0, 1.0), (1.0, 0.0, 0.0))
    heavy = Body("ball", 0.1, 3.0, (0.0, 0.0, 1.0))
    scene = Scene((light, heavy), gravity=(0.0, 0.0, 0.0), restitution=1.0, dt=dt)
    world = build(scene)
    before = world.motion()
    world.step(round(1.0 / dt))
    after = world.motion().checked()
    change = 100.0 * (energy(scene, after) / energy(scene, before) - 1.0)
    lost = float(np.linalg.norm(momentum(scene, after) - momentum(scene, before)))
    return Outcome(change, {"velocities_m_s": after.v[:, 0].tolist(), "momentum_error_kg_m_s": lost})


def rebound(build: Build, dt: float, quick: bool, *, height: float, unit: float) -> Outcome:
    """How high a ball comes back that falls from a height (m), in ``unit`` to the metre; mean over phases."""
    runs = [_rebound(build, dt, height, early, unit) for early in _phases(dt, quick)]
    return _one_of(statistics.fmean, runs)


def _rebound(build: Build, dt: float, height: float, early: float, unit: float) -> Outcome:
    """One rebound; the ball starts ``early`` seconds down its fall, so its energy is that of ``height``."""
    radius, restitution = 0.1, 0.5
    start = (0.0, 0.0, radius + height - 0.5 * G * early**2)
    ball = Body("ball", radius, 1.0, start, (0.0, 0.0, -G * early))
    world = build(Scene((ball,), floor=True, restitution=restitution, dt=dt))
    fall = math.sqrt(2.0 * height / G)
    # Down, then up and almost down again: the second landing must not count as a start.
    n = round((fall + 1.9 * restitution * fall) / dt)
    highest, lowest, rising = 0.0, height, False
    for _ in range(n):
        world.step()
        now = world.motion().checked()
        gap = float(now.x[0, 2]) - radius
        lowest = min(lowest, gap)
        rising = rising or (lowest < 0.5 * height and now.v[0, 2] > 0.0)
        if rising:
            highest = max(highest, gap)
    return Outcome(unit * highest, {"lowest_m": lowest})


def _on_slope(degrees: float, friction: float, dt: float) -> Scene:
    """A cube of half a metre at rest on the floor; instead of the floor, gravity is tilted."""
    angle = math.radians(degrees)
    return Scene(
        (Body("cube", 0.25, 1.0, (0.0, 0.0, 0.25)),),
        gravity=(G * math.sin(angle), 0.0, -G * math.cos(angle)),
        friction=friction,
        floor=True,
        dt=dt,
    )


def slide(build: Build, dt: float, quick: bool) -> Outcome:  # noqa: ARG001
    """By how many per cent a box accelerates too much down a slope."""
    world = build(_on_slope(30.0, 0.3, dt))
    first, second = round(0.25 / dt), round(0.75 / dt)
    world.step(first)
    v0 = world.motion().checked().v[0, 0]
    world.step(second)
    v1 = world.motion().checked().v[0, 0]
    angle = math.radians(30.0)
    true = G * (math.sin(angle) - 0.3 * math.cos(angle))
    measured = float(v1 - v0) / (second * dt)
    return Outcome(100.0 * (measured / true - 1.0), {"acceleration_m_s2": measured, "true_m_s2": true})


def stick(build: Build, dt: float, quick: bool) -> Outcome:  # noqa: ARG001
    """How far a box creeps that must not move, mm in 2 s, once it has settled for a quarter of a second."""
    world = build(_on_slope(20.0, 0.5, dt))
    world.step(round(0.25 / dt))
    x0 = world.motion().checked().x[0, 0]
    world.step(round(2.0 / dt))
    return Outcome(1000.0 * float(world.motion().checked().x[0, 0] - x0), {})


def diagonal(build: Build, dt: float, quick: bool) -> Outcome:
    """The least push along the diagonal that makes a box slip, over the least push along an edge."""
    rounds = 8 if quick else 11
    edge, corner = (_slip_force(build, dt, math.radians(degrees), rounds) for degrees in (0.0, 45.0))
    return Outcome(corner / edge, {"edge": edge, "corner": corner, "unit": "mu m g"})


def _slip_force(build: Build, dt: float, direction: float, rounds: int) -> float:
    """By bisection, as a multiple of mu m g; the push is a part of gravity, which acts on the centre."""
    friction, low, high = 0.5, 0.2, 2.2
    for _ in range(rounds):
        middle = 0.5 * (low + high)
        push = middle * friction * G
        gravity = (push * math.cos(direction), push * math.sin(direction), -G)
        cube = Body("cube", 0.25, 1.0, (0.0, 0.0, 0.25))
        world = build(Scene((cube,), gravity=gravity, friction=friction, floor=True, dt=dt))
        world.step(round(0.5 / dt))
        v = world.motion().checked().v[0]
        if math.hypot(v[0], v[1]) > _SLIPS:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def _moved(build: Build, scenes: list[Scene], seconds: float) -> Outcome:
    """The largest movement of any body that should stand still, mm; the median over the starts."""
    return _one_of(statistics.median, [_movement(build, scene, seconds) for scene in scenes])


def _movement(build: Build, scene: Scene, seconds: float) -> Outcome:
    world = build(scene)
    start = world.motion()
    world.step(round(seconds / scene.dt))
    end: Motion = world.motion().checked()
    gone = np.linalg.norm(end.x - start.x, axis=1)
    depths = world.overlaps()
    details = {"contacts": len(depths), "deepest_overlap_mm": 1000.0 * max(depths, default=0.0)}
    return Outcome(1000.0 * float(np.max(gone)), details)


def _piles(masses: list[float], dt: float, quick: bool) -> list[Scene]:
    """Cubes of 20 cm on top of each other, the same start but for offsets too small to matter."""
    half = 0.1
    scenes = []
    for start in range(STARTS // 2 + 1 if quick else STARTS):
        # To the right and to the left in turn: a pile that falls over may not lean to begin with.
        offsets = [start * _OFFSET_M * (-1.0) ** i for i in range(len(masses))]
        gap = (start - 1.5) * _OFFSET_M
        cubes = tuple(
            Body("cube", half, mass, (offset, 0.0, half + gap + (2.0 * half + gap) * i))
            for i, (mass, offset) in enumerate(zip(masses, offsets, strict=True))
        )
        scenes.append(Scene(cubes, friction=0.5, floor=True, dt=dt))
    return scenes


def stack(build: Build, dt: float, quick: bool) -> Outcome:
    """How far the boxes of a stack of ten move in 5 s (quick: 2 s), mm."""
    return _moved(build, _piles([1.0] * 10, dt, quick), 2.0 if quick else 5.0)


def mass_ratio(build: Build, dt: float, quick: bool) -> Outcome:
    """How far two cubes move in 2 s, the upper one a thousand times as heavy, mm."""
    return _moved(build, _piles([1.0, 1000.0], dt, quick), 2.0)


def thin_wall(build: Build, dt: float, quick: bool) -> Outcome:
    """The fastest ball that a wall of 2 cm stops, of those where every slower one was stopped too, m/s."""
    stopped, through = 0.0, None
    phases = [late / dt for late in _phases(dt, quick)]
    for speed in SPEEDS:
        if not all(_stopped(build, dt, speed, phase) for phase in phases):
            through = speed
            break
        stopped = speed
    return Outcome(stopped, {"passed_at_m_s": through, "fastest_tried_m_s": SPEEDS[-1]})


def _stopped(build: Build, dt: float, speed: float, phase: float) -> bool:
    """A ball starts 0.5 m away, and ``phase`` of a step more: where in a step it arrives decides much."""
    ball = Body("ball", 0.05, 1.0, (-0.5 - phase * speed * dt, 0.0, 0.0), (speed, 0.0, 0.0))
    wall = Wall((0.0, 0.0, 0.0), (0.01, 1.0, 1.0))
    world = build(Scene((ball,), gravity=(0.0, 0.0, 0.0), walls=(wall,), dt=dt))
    world.step(math.ceil((1.0 / speed) / dt) + 20)
    return float(world.motion().checked().x[0, 0]) < 0.0


def boxes_scene(dt: float) -> Scene:
    """A hundred cubes in a row of twenty columns of five, in contact; the row serves the plane as well."""
    half, gap = 0.1, 0.3
    cubes = tuple(
        Body("cube", half, 1.0, (gap * column, 0.0, half + 2.0 * half * level))
        for column in range(20)
        for level in range(5)
    )
    return Scene(cubes, friction=0.5, floor=True, dt=dt)


#: The default step of comparisons, s.
DT = 1.0 / 240.0
#: The scenario that measures speed; everything else measures accuracy.
BOXES = "boxes"
#: Scenarios whose value is the mean over phases of a step.
IMPACTS = ("clash", "bounce", "small-drop")


@dataclass(frozen=True, slots=True)
class Scenario:
    """One test.

    Attributes:
        question: a question to answer before seeing the numbers.
        quantity: the meaning of ``value``.
        run: measures once, given how to build a scene, the step (s) and whether it should be quick. It may
            raise EngineDivergedError, and NotApplicableError where an engine has no word for the scene. None
            for the speed, which takes turns with another engine.
        source: of the truth.
        truth: the right value; None where there is none (a speed), inf for "any speed".
        unit: of ``value`` and ``truth``; "%" and "mm" are meant for reading.
        digits: decimals worth showing.
        converges: a curve of its error against the step makes sense, because only the integrator matters.
    """

    id: str
    title: str
    question: str
    quantity: str
    run: Callable[[Build, float, bool], Outcome] | None
    source: str
    truth: float | None = 0.0
    unit: str = "%"
    digits: int = 3
    converges: bool = False

    @property
    def better(self) -> Literal["near", "large"]:
        """Whether the value nearer the truth is better, or the larger one."""
        return "large" if self.truth is None or math.isinf(self.truth) else "near"

    def error(self, value: float) -> float | None:
        """How far a value is from the truth, in the scenario's unit; None if the truth is unknown."""
        return None if self.truth is None or self.better == "large" else value - self.truth


SCENARIOS: dict[str, Scenario] = {
    one.id: one
    for one in (
        Scenario(
            "free-fall",
            "A free fall",
            "Only gravity acts. Which engines let a body fall too far, which not far enough, by how much?",
            "error of the distance fallen",
            free_fall,
            "g t² / 2",
            converges=True,
        ),
        Scenario(
            "pendulum",
            "A pendulum on a hinge",
            "One ball on a rod swings from the horizontal for two seconds. How far does it stray?",
            "largest distance from the true path, in per cent of the rod",
            pendulum,
            "the pendulum's equation, solved with RK4 at a step of at most 1 ms",
            digits=4,
            converges=True,
        ),
        Scenario(
            "double-pendulum",
            "A double pendulum's energy",
            "Two hinges, no friction, ten seconds. How much of the energy is left?",
            "largest change of energy within 10 s, median over the starts",
            double_pendulum,
            "conservation of energy",
        ),
        Scenario(
            "long-step",
            "A long step",
            "The same double pendulum, with the step doubled again and again. How long may it be?",
            "longest step that keeps the energy within 10 % for 10 s, from every start",
            long_step,
            "conservation of energy",
            truth=math.inf,
            unit="ms",
            digits=1,
        ),
        Scenario(
            "clash",
            "An elastic collision of masses 1 and 3",
            "The light ball meets the resting heavy one at 1 m/s. Is the energy still there afterwards?",
            "change of kinetic energy, mean over phases of a step",
            clash,
            "restitution 1 conserves kinetic energy",
        ),
        Scenario(
            "bounce",
            "A bounce",
            "A ball falls from 1 m on a floor; restitution 0.5. How high does it come back?",
            "height of the rebound, mean over phases of a step",
            partial(rebound, height=1.0, unit=1.0),
            "e² h",
            truth=0.25,
            unit="m",
            digits=4,
        ),
        Scenario(
            "small-drop",
            "A bounce from 2 cm",
            "The same ball, dropped from two centimetres. Does it still bounce?",
            "height of the rebound, mean over phases of a step",
            partial(rebound, height=0.02, unit=1000.0),
            "e² h",
            truth=5.0,
            unit="mm",
            digits=2,
        ),
        Scenario(
            "slide",
            "A box slides down a slope",
            "30 degrees, friction 0.3. Is the acceleration right?",
            "error of the acceleration",
            slide,
            "g (sin a - mu cos a)",
        ),
        Scenario(
            "stick",
            "A box sticks to a slope",
            "20 degrees, friction 0.5: it must stay. Does it creep?",
            "distance moved down the slope in 2 s",
            stick,
            "tan a < mu",
            unit="mm",
        ),
        Scenario(
            "diagonal",
            "Friction along the diagonal",
            "A box is pushed until it slips, along an edge and along the diagonal. Cone or pyramid?",
            "force at which the box slips along the diagonal, divided by that along an edge",
            diagonal,
            "Coulomb's cone has no preferred direction",
            truth=1.0,
            unit="1",
        ),
        Scenario(
            "stack",
            "A stack of ten boxes",
            "Nothing should move. What does?",
            "largest movement of any box, median over the starts",
            stack,
            "it stands in equilibrium",
            unit="mm",
            digits=2,
        ),
        Scenario(
            "mass-ratio",
            "A tonne on a kilogram",
            "A cube of 1000 kg on one of 1 kg. Does the small one hold?",
            "largest movement of either, median over the starts",
            mass_ratio,
            "it stands in equilibrium",
            unit="mm",
            digits=2,
        ),
        Scenario(
            "thin-wall",
            "A thin wall and a fast ball",
            "A ball of 10 cm flies at a wall of 2 cm, faster each time. When does it get through?",
            "speed of the fastest ball that was stopped, as every slower one was",
            thin_wall,
            "solid bodies do not pass through each other",
            truth=math.inf,
            unit="m/s",
            digits=0,
        ),
        Scenario(
            BOXES,
            "A hundred boxes, for speed",
            "Columns of boxes in contact. How many steps a second, and how many times pymunk's rate is that?",
            "rate, as a multiple of pymunk's in the same run",
            None,
            "",
            truth=None,
            unit="x",
            digits=2,
        ),
    )
}


def get(scenario_id: str) -> Scenario:
    if scenario_id in SCENARIOS:
        return SCENARIOS[scenario_id]
    problem = f"There is no scenario {scenario_id!r}."
    advice = meant(scenario_id, SCENARIOS, f"The scenarios are {', '.join(SCENARIOS)}.")
    raise NotFoundError(problem, help=advice, code="scenario_not_found")

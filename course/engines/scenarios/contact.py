"""Scenarios with contact: restitution, friction, stacks and walls."""

from __future__ import annotations

import math
import statistics
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from course.engines.base import Body, Scene, Wall, energy, momentum

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from course.engines.base import Motion, World

    Build = Callable[[Scene], World]
    Measured = tuple[float, dict[str, Any]]

__all__ = ["PHASES", "SPEEDS", "STARTS", "bounce", "boxes", "boxes_scene", "clash", "diagonal", "mass_ratio",
           "slide", "small_drop", "stack", "stick", "thin_wall"]  # fmt: skip

G = 9.81
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


def _mean(samples: list[float], details: list[dict[str, Any]]) -> Measured:
    """The mean over the phases, the single values, and further details."""
    return statistics.fmean(samples), {"samples": samples, **_together(details)}


def _together(details: list[dict[str, Any]]) -> dict[str, Any]:
    """The details of several runs as those of one: the worst where that is a number, else the first run's."""
    return {
        name: _WORST[name](one[name] for one in details) if name in _WORST else details[0][name]
        for name in details[0]
    }


def clash(build: Build, dt: float, quick: bool) -> Measured:
    """By how many per cent an elastic collision changes the kinetic energy; the mean over phases."""
    found = [_clash(build, dt, late) for late in _phases(dt, quick)]
    return _mean([value for value, _ in found], [details for _, details in found])


def _clash(build: Build, dt: float, late: float) -> Measured:
    light = Body("ball", 0.1, 1.0, (-0.5 - late, 0.0, 1.0), (1.0, 0.0, 0.0))
    heavy = Body("ball", 0.1, 3.0, (0.0, 0.0, 1.0))
    scene = Scene((light, heavy), gravity=(0.0, 0.0, 0.0), restitution=1.0, dt=dt)
    world = build(scene)
    before = world.motion()
    world.step(round(1.0 / dt))
    after = world.motion().checked()
    change = 100.0 * (energy(scene, after) / energy(scene, before) - 1.0)
    lost = float(np.linalg.norm(momentum(scene, after) - momentum(scene, before)))
    return change, {"velocities_m_s": after.v[:, 0].tolist(), "momentum_error_kg_m_s": lost}


def bounce(build: Build, dt: float, quick: bool) -> Measured:
    """How high a ball comes back that falls from 1 m, m; the mean over phases."""
    return _rebounds(build, dt, quick, 1.0, 1.0)


def small_drop(build: Build, dt: float, quick: bool) -> Measured:
    """How high a ball comes back that falls from 2 cm, mm; the mean over phases."""
    return _rebounds(build, dt, quick, 0.02, 1000.0)


def _rebounds(build: Build, dt: float, quick: bool, height: float, unit: float) -> Measured:
    found = [_rebound(build, dt, height, early) for early in _phases(dt, quick)]
    return _mean([unit * value for value, _ in found], [details for _, details in found])


def _rebound(build: Build, dt: float, height: float, early: float, restitution: float = 0.5) -> Measured:
    """One rebound; the ball starts ``early`` seconds down its fall, so its energy is that of ``height``."""
    radius = 0.1
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
    return highest, {"lowest_m": lowest}


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


def slide(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001
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
    return 100.0 * (measured / true - 1.0), {"acceleration_m_s2": measured, "true_m_s2": true}


def stick(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001
    """How far a box creeps that must not move, mm in 2 s, once it has settled for a quarter of a second."""
    world = build(_on_slope(20.0, 0.5, dt))
    world.step(round(0.25 / dt))
    x0 = world.motion().checked().x[0, 0]
    world.step(round(2.0 / dt))
    return 1000.0 * float(world.motion().checked().x[0, 0] - x0), {}


def diagonal(build: Build, dt: float, quick: bool) -> Measured:
    """The least push along the diagonal that makes a box slip, over the least push along an edge."""
    rounds = 8 if quick else 11
    edge, corner = (_slip_force(build, dt, math.radians(degrees), rounds) for degrees in (0.0, 45.0))
    return corner / edge, {"edge": edge, "corner": corner, "unit": "mu m g"}


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


def _moved(build: Build, scenes: list[Scene], seconds: float) -> Measured:
    """The largest movement of any body that should stand still, mm; the median over the starts."""
    found = [_movement(build, scene, seconds) for scene in scenes]
    samples = [value for value, _ in found]
    return statistics.median(samples), {"samples": samples, **_together([details for _, details in found])}


def _movement(build: Build, scene: Scene, seconds: float) -> Measured:
    world = build(scene)
    start = world.motion()
    world.step(round(seconds / scene.dt))
    end: Motion = world.motion().checked()
    gone = np.linalg.norm(end.x - start.x, axis=1)
    points, depth = world.contacts()
    return 1000.0 * float(gone.max()), {"contacts": points, "deepest_overlap_mm": 1000.0 * depth}


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


def stack(build: Build, dt: float, quick: bool) -> Measured:
    """How far the boxes of a stack of ten move in 5 s (quick: 2 s), mm."""
    return _moved(build, _piles([1.0] * 10, dt, quick), 2.0 if quick else 5.0)


def mass_ratio(build: Build, dt: float, quick: bool) -> Measured:
    """How far two cubes move in 2 s, the upper one a thousand times as heavy, mm."""
    return _moved(build, _piles([1.0, 1000.0], dt, quick), 2.0)


def thin_wall(build: Build, dt: float, quick: bool) -> Measured:
    """The fastest ball that a wall of 2 cm stops, of those where every slower one was stopped too, m/s."""
    stopped, through = 0.0, None
    phases = [late / dt for late in _phases(dt, quick)]
    for speed in SPEEDS:
        if not all(_stopped(build, dt, speed, phase) for phase in phases):
            through = speed
            break
        stopped = speed
    return stopped, {"passed_at_m_s": through, "fastest_tried_m_s": SPEEDS[-1]}


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


def boxes(build: Build, dt: float, quick: bool) -> Measured:
    """Steps a second of processor time with a hundred boxes, after a quarter of a second to settle."""
    world = build(boxes_scene(dt))
    world.step(round(0.25 / dt))
    n = 60 if quick else 240
    started = time.process_time()
    world.step(n)
    rate = n / max(time.process_time() - started, 1e-6)
    world.motion().checked()
    return rate, {"contacts": world.contacts()[0]}

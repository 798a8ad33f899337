"""Scenarios in which things touch: restitution, friction, stacks and walls."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from course.engines.base import Body, Scene, Wall, energy, momentum

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.engines.base import Motion, World

    Build = Callable[[Scene], World]
    Measured = tuple[float, dict[str, Any]]

__all__ = ["SPEEDS", "bounce", "boxes", "boxes_scene", "clash", "diagonal", "mass_ratio", "slide",
           "small_drop", "stack", "stick", "thin_wall"]  # fmt: skip

G = 9.81
#: Of the balls at the thin wall, m/s.
SPEEDS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 400.0)
#: A push is raised until the box is faster than this within half a second, m/s.
_SLIPS = 0.01


def clash(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001 - it is quick as it is
    """By how many per cent an elastic collision changes the kinetic energy."""
    light = Body("ball", 0.1, 1.0, (-0.5, 0.0, 1.0), (1.0, 0.0, 0.0))
    heavy = Body("ball", 0.1, 3.0, (0.0, 0.0, 1.0))
    scene = Scene((light, heavy), gravity=(0.0, 0.0, 0.0), restitution=1.0, dt=dt)
    world = build(scene)
    before = world.motion()
    world.step(round(1.0 / dt))
    after = world.motion().checked()
    change = 100.0 * (energy(scene, after) / energy(scene, before) - 1.0)
    lost = float(np.linalg.norm(momentum(scene, after) - momentum(scene, before)))
    return change, {"velocities_m_s": after.v[:, 0].tolist(), "momentum_error_kg_m_s": lost}


def bounce(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001
    """How high a ball comes back that falls from 1 m, m."""
    return _rebound(build, dt, 1.0)


def small_drop(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001
    """How high a ball comes back that falls from 2 cm, mm."""
    height, details = _rebound(build, dt, 0.02)
    return 1000.0 * height, details


def _rebound(build: Build, dt: float, height: float, restitution: float = 0.5) -> Measured:
    radius = 0.1
    scene = Scene(
        (Body("ball", radius, 1.0, (0.0, 0.0, radius + height)),), floor=True, restitution=restitution, dt=dt
    )
    world = build(scene)
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


def _moved(build: Build, scene: Scene, seconds: float) -> Measured:
    """The largest movement of any body that should stand still, mm."""
    world = build(scene)
    start = world.motion()
    world.step(round(seconds / scene.dt))
    end: Motion = world.motion().checked()
    gone = np.linalg.norm(end.x - start.x, axis=1)
    points, depth = world.contacts()
    return 1000.0 * float(gone.max()), {"contacts": points, "deepest_overlap_mm": 1000.0 * depth}


def stack(build: Build, dt: float, quick: bool) -> Measured:
    """How far the boxes of a stack of ten move in 5 s (quick: 2 s), mm."""
    half = 0.1
    cubes = tuple(Body("cube", half, 1.0, (0.0, 0.0, half + 2.0 * half * i)) for i in range(10))
    return _moved(build, Scene(cubes, friction=0.5, floor=True, dt=dt), 2.0 if quick else 5.0)


def mass_ratio(build: Build, dt: float, quick: bool) -> Measured:  # noqa: ARG001
    """How far two cubes move in 2 s, the upper one a thousand times as heavy, mm."""
    half = 0.1
    small = Body("cube", half, 1.0, (0.0, 0.0, half))
    large = Body("cube", half, 1000.0, (0.0, 0.0, 3.0 * half))
    return _moved(build, Scene((small, large), friction=0.5, floor=True, dt=dt), 2.0)


def thin_wall(build: Build, dt: float, quick: bool) -> Measured:
    """The fastest ball that a wall of 2 cm stops, of those where every slower one was stopped too, m/s."""
    stopped, through = 0.0, None
    for speed in SPEEDS:
        if not all(_stopped(build, dt, speed, phase / 8.0) for phase in range(0, 8, 2 if quick else 1)):
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

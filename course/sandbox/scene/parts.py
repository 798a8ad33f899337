"""A scene in numbers: every body with its position, outline, mass and moment of inertia.

The world builds pymunk's bodies from these, and the exports write them into other engines' files, so that all
of them start from the same numbers.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from course.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from course.sandbox.scene.model import Body, Material, Scene, Wheels

__all__ = ["Part", "layout", "spawned"]

Vector = tuple[float, float]

#: Colours in turn for bodies that name none; distinguishable for colour-blind people.
PALETTE = ("#4477aa", "#ee6677", "#ccbb44", "#66ccee", "#aa3377", "#228833")
FIXED_COLOUR = "#8a8f98"


@dataclass(frozen=True, slots=True)
class Part:
    """One body.

    Attributes:
        name, shape: as in the scene; a box is a polygon of four points from here on.
        outline: corners in the body's frame, in m, counter-clockwise; two ends for a segment; empty for a
            circle.
        appears: when it enters the scene, in s.
        radius: of a circle; half the thickness of a segment; 0 for a polygon. In m.
        x, y, angle, vx, vy, spin: at the start; m, rad, m/s, rad/s.
        mass, moment: kg and kg m² about the centre; 0 for a fixed body, and ``inf`` for a moment that is not
            to turn.
    """

    name: str
    shape: str
    outline: tuple[Vector, ...]
    radius: float
    x: float
    y: float
    angle: float
    vx: float
    vy: float
    spin: float
    mass: float
    moment: float
    fixed: bool
    restitution: float
    friction: float
    colour: str
    wheels: Wheels | None = None
    size: Vector | None = None
    appears: float = 0.0


def layout(scene: Scene) -> tuple[Part, ...]:
    """Every body of a scene, copies written out, in the scene's order.

    The same scene and seed give the same numbers, whatever ``reverse`` says.
    """
    chance = random.Random(scene.seed)
    parts: list[Part] = []
    moving = 0
    for body in scene.body:
        material = scene.materials[body.material]
        for number, (name, x, y) in enumerate(_places(body, chance)):
            colour = FIXED_COLOUR if body.fixed else PALETTE[moving % len(PALETTE)]
            part = _part(body, material, name, (x, y), body.colour or colour)
            parts.append(replace(part, appears=number * body.interval) if body.interval else part)
            moving += not body.fixed
    return tuple(parts)


def spawned(name: str, shape: str, size: float, place: Vector, velocity: Vector, material: Material) -> Part:
    """A body that a user adds to a running world.

    Args:
        shape: "circle" or "box".
        size: radius, or half the side, in m.
    """
    from course.sandbox.scene.model import Body

    box = shape == "box"
    body = Body(
        name="spawned",
        shape="box" if box else "circle",
        material="spawned",
        radius=None if box else size,
        size=(2 * size, 2 * size) if box else None,
        position=place,
        velocity=velocity,
    )
    return _part(body, material, name, place, PALETTE[sum(map(ord, name)) % len(PALETTE)])


def _places(body: Body, chance: random.Random) -> Iterator[tuple[str, float, float]]:
    """Name and place of each copy."""
    offsets: list[Vector] = [(0.0, 0.0)]
    for repeat in body.repeat:
        offsets = [
            (dx + i * repeat.offset[0], dy + i * repeat.offset[1])
            for i in range(repeat.count)
            for dx, dy in offsets
        ]
    for number, (dx, dy) in enumerate(offsets, 1):
        x, y = body.position[0] + dx, body.position[1] + dy
        if body.jitter:
            x += chance.uniform(-body.jitter, body.jitter)
            y += chance.uniform(-body.jitter, body.jitter)
        yield (f"{body.name}-{number}" if body.repeat else body.name), x, y


def _part(body: Body, material: Material, name: str, place: Vector, colour: str) -> Part:
    turn = math.radians(body.turn_deg)
    angle = math.radians(body.angle_deg) + turn
    outline, radius = _outline(body)
    x, y = _turned(place[0] - body.about[0], place[1] - body.about[1], turn)
    x, y = x + body.about[0], y + body.about[1]
    if body.shape == "polygon":
        # The centre of mass is where the engine turns a body about; the picture stays where it was drawn.
        cx, cy = _centroid(outline)
        outline = tuple((px - cx, py - cy) for px, py in outline)
        dx, dy = _turned(cx, cy, angle)
        x, y = x + dx, y + dy
    vx, vy = _turned(*body.velocity, turn)
    mass = 0.0 if body.fixed else body.mass or material.density * _area(body, outline)
    moment = 0.0 if body.fixed else _moment(body, outline, mass) if body.rotates else math.inf
    if not (body.fixed or (mass > 0.0 and moment > 0.0)):
        raise UsageError(
            f"{name} has a mass of {mass:g} kg and a moment of {moment:g} kg m², too small to count.",
            help="Make it larger or heavier.",
            code="bad_scene",
        )
    return Part(
        name=name,
        shape="polygon" if body.shape == "box" else body.shape,
        outline=outline,
        radius=radius,
        x=x,
        y=y,
        angle=angle,
        vx=vx,
        vy=vy,
        spin=body.spin,
        mass=mass,
        moment=moment,
        fixed=body.fixed,
        restitution=material.restitution,
        friction=material.friction,
        colour=colour,
        wheels=body.wheels,
        size=body.size if body.shape == "box" else None,
    )


def _outline(body: Body) -> tuple[tuple[Vector, ...], float]:
    if body.shape == "circle":
        return (), body.radius or 0.0
    if body.shape == "segment":
        return body.points or (), (body.thickness or 0.0) / 2
    if body.shape == "box":
        width, height = body.size or (0.0, 0.0)
        w, h = width / 2, height / 2
        return ((-w, -h), (w, -h), (w, h), (-w, h)), 0.0
    points = body.points or ()
    return (points if signed_area(points) > 0 else points[::-1]), 0.0


def _turned(x: float, y: float, angle: float) -> Vector:
    if angle == 0.0:
        return x, y
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


def signed_area(points: Sequence[Vector]) -> float:
    """Area of a polygon in m², positive if its corners run counter-clockwise."""
    ends = [*points[1:], *points[:1]]
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(points, ends, strict=True)) / 2


def _centroid(points: Sequence[Vector]) -> Vector:
    ends = [*points[1:], *points[:1]]
    crosses = [x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(points, ends, strict=True)]
    six = 3 * sum(crosses)
    x = sum((x0 + x1) * c for (x0, _), (x1, _), c in zip(points, ends, crosses, strict=True)) / six
    y = sum((y0 + y1) * c for (_, y0), (_, y1), c in zip(points, ends, crosses, strict=True)) / six
    return x, y


def _area(body: Body, outline: Sequence[Vector]) -> float:
    return math.pi * (body.radius or 0.0) ** 2 if body.shape == "circle" else signed_area(outline)


def _moment(body: Body, outline: Sequence[Vector], mass: float) -> float:
    """About the centre of mass. Source: any table of moments; the polygon's is the sum over its triangles."""
    if body.shape == "circle":
        return mass * (body.radius or 0.0) ** 2 / 2
    ends = [*outline[1:], *outline[:1]]
    top = bottom = 0.0
    for (x0, y0), (x1, y1) in zip(outline, ends, strict=True):
        cross = x0 * y1 - x1 * y0
        top += cross * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1)
        bottom += cross
    return mass * top / (6 * bottom)

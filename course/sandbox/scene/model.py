"""Scenes: the fields of a file under ``scenes/``, or of a student's own file.

Everything is in SI units and in the plane: x to the right, y up, angles counter-clockwise. Lengths in m,
masses in kg, times in s; a name that ends in ``_deg`` is in degrees. Ranges are part of the types, so that a
file out of range is refused with its line; what a type cannot say is checked in
``course.sandbox.scene.rules``.
"""

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Literal, assert_never

import msgspec
from msgspec import Meta

from course.errors import UsageError

#: Values beyond these are typing errors; 10 km and 10 km/s are far outside anything drawn.
Length = Annotated[float, Meta(gt=0, le=1e4)]
Coordinate = Annotated[float, Meta(ge=-1e4, le=1e4)]
Speed = Annotated[float, Meta(ge=-1e4, le=1e4)]
Fraction = Annotated[float, Meta(ge=0, le=1)]
Coefficient = Annotated[float, Meta(ge=0, le=10)]
Count = Annotated[int, Meta(ge=1, le=2000)]
Text = Annotated[str, Meta(min_length=1, max_length=2000)]
_A_COLOUR = 'a colour in six hexadecimal digits, with small letters, such as "#1f77b4"'
_A_NAME = 'a name of small letters and digits with hyphens between, such as "left-puck"'
Name = Annotated[str, Meta(pattern=r"^[a-z][a-z0-9]*(-[a-z0-9]+)*$", max_length=40, description=_A_NAME)]
#: Names a body, or several with ``*`` at the end: ``ball-*``.
Pattern = Annotated[
    str,
    Meta(
        pattern=r"^(\*|[a-z][a-z0-9]*(-[a-z0-9]+)*(-?\*)?)$",
        max_length=41,
        description=f"{_A_NAME}, or the beginning of one and *",
    ),
]

Point = tuple[Coordinate, Coordinate]
#: The shape of a body as a scene says it, and as the engine and all views know it: a box has four corners.
Shape = Literal["circle", "box", "polygon", "segment"]
Form = Literal["circle", "polygon", "segment"]
#: What a probe reads: of one body, and of several together.
OfOne = Literal["x", "y", "vx", "vy", "speed", "angle_deg", "spin"]
OfMany = Literal["kinetic", "momentum_x", "contacts", "contact_time", "count", "mean", "spread"]


class Material(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The material of a body.

    Attributes:
        restitution: 1 keeps the speed of approach, 0 none of it. The values of two shapes are multiplied, so
            two balls of 0.8 separate with 0.64 of it.
        friction: Coulomb's coefficient; also multiplied.
        density: in kg/m², mass per area, since bodies are flat.
    """

    name: Name
    restitution: Fraction = 0.5
    friction: Coefficient = 0.5
    density: Annotated[float, Meta(gt=0, le=1e6)] = 1.0


class Repeat(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The same body several times in a row; two of them make a grid.

    Attributes:
        offset: from one to the next, in m.
    """

    count: Count
    offset: Point


class Wheels(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Two driven wheels beside each other on a body seen from above; it drives along its own x axis.

    Attributes:
        track: distance between the wheels, in m.
        left, right: speed of each rim, in m/s.
        grip: friction between wheel and floor.
    """

    track: Length
    left: Speed = 0.0
    right: Speed = 0.0
    grip: Coefficient = 0.8


class Body(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One body, or a row or grid of equal ones, which are then called name-1, name-2 and so on.

    Attributes:
        name: its name in events and probes.
        shape: a circle needs ``radius``, a box ``size``, a polygon ``points`` (convex, around the body's
            position), a segment two ``points`` and a ``thickness``.
        material: the name of one of the scene's materials.
        position: in m, of the centre of mass.
        angle_deg, velocity, spin: at the start; in degrees, m/s and rad/s.
        mass: in kg; area times density if left out.
        fixed: it never moves.
        rotates: False gives it an infinite moment of inertia.
        repeat: copies; the first stands at ``position``.
        jitter: each coordinate of each copy is moved by up to this, in m, drawn from the scene's seed.
        interval: copies appear one after another, this far apart, in s.
        turn_deg, about: everything above is turned by this angle about this point, velocity included.
        colour: for views, as ``#rrggbb``.
    """

    name: Name
    shape: Shape
    material: Name
    position: Point = (0.0, 0.0)
    angle_deg: Annotated[float, Meta(ge=-3600, le=3600)] = 0.0
    velocity: tuple[Speed, Speed] = (0.0, 0.0)
    spin: Annotated[float, Meta(ge=-1000, le=1000)] = 0.0
    radius: Length | None = None
    size: tuple[Length, Length] | None = None
    points: Annotated[tuple[Point, ...], Meta(min_length=2, max_length=32)] | None = None
    thickness: Length | None = None
    mass: Annotated[float, Meta(gt=0, le=1e6)] | None = None
    fixed: bool = False
    rotates: bool = True
    repeat: Annotated[tuple[Repeat, ...], Meta(max_length=2)] = ()
    jitter: Annotated[float, Meta(ge=0, le=10)] = 0.0
    interval: Annotated[float, Meta(ge=0, le=100)] = 0.0
    turn_deg: Annotated[float, Meta(ge=-3600, le=3600)] = 0.0
    about: Point = (0.0, 0.0)
    wheels: Wheels | None = None
    colour: Annotated[str, Meta(pattern=r"^#[0-9a-f]{6}$", description=_A_COLOUR)] | None = None


class Joint(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A connection of two bodies.

    Attributes:
        kind: a rod keeps the distance of its two anchors, a pivot keeps them together.
        name: only for ``sets``.
        a, b: bodies; at least one of them can move.
        anchor_a, anchor_b: in the body's own frame, in m from its centre.
        touch: whether the two bodies collide with each other.
    """

    kind: Literal["rod", "pivot"]
    name: Name | None = None
    a: Name
    b: Name
    anchor_a: Point = (0.0, 0.0)
    anchor_b: Point = (0.0, 0.0)
    touch: bool = False


class Floor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The ground of a scene seen from above, with friction on everything that slides on it.

    Attributes:
        friction: Coulomb's coefficient.
        gravity: presses bodies onto it, in m/s².
    """

    friction: Coefficient
    gravity: Annotated[float, Meta(ge=0, le=1000)] = 9.81


class Parameter(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A number of the scene's own that ``--set`` may change; ``Scene.sets`` says where it goes."""

    name: Name
    meaning: Text
    unit: str
    default: float
    low: float
    high: float


class Probe(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A number that is read from a run.

    Attributes:
        quantity: what; ``contacts`` counts them, ``contact_time`` is that of the first one, ``count`` is how
            many of the bodies end inside ``region``, ``spread`` and ``mean`` are of their x.
        of: whose; several bodies (``ball-*``) for a total, a count, a mean or a spread.
        other: the partner of a contact.
        when: at which moment; ``after`` is just after the first contact of ``of`` and ``other``.
        time: for ``when = "at"``, in s; a number, or a formula in what ``theory`` may use: ``"step"``.
        region: left, bottom, right, top, in m.
        change: since the start, instead of the value itself.
        scale: the value is multiplied by this, which is how it gets another unit.
    """

    name: Name
    quantity: Literal[OfOne, OfMany]
    of: Pattern
    other: Name | None = None
    when: Literal["start", "end", "max", "min", "at", "after"] = "end"
    time: Annotated[float, Meta(ge=0, le=1e5)] | Text | None = None
    region: tuple[Coordinate, Coordinate, Coordinate, Coordinate] | None = None
    change: bool = False
    unit: str = ""
    scale: float = 1.0


class Prediction(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A number to guess before the run.

    ``question`` and ``why`` hold formulas for the numbers that settings change: ``{speed * step:.2f}``, in
    the names that ``theory`` may use; see ``course.sandbox.scene.expression``.

    Attributes:
        probe: what answers it.
        theory: a formula for it in parameters, ``g``, ``step`` and ``body.mass`` and the like.
        why: where the formula comes from, and the usual reasoning behind a wrong guess.
        near: a guess this close to theory or simulation counts as close; a fraction of the answer.
        near_abs: the same as a number, for answers near zero.
        agrees: how far simulation and theory may be apart, as a fraction of the theory.
        agrees_abs: the same as a number.
        agrees_because: where that comes from.
    """

    question: Text
    probe: Name
    unit: str
    theory: Text
    why: Text
    near: Annotated[float, Meta(ge=0, le=1)] = 0.1
    near_abs: Annotated[float, Meta(ge=0)] = 0.0
    agrees: Annotated[float, Meta(ge=0, le=1)] = 0.0
    agrees_abs: Annotated[float, Meta(ge=0)] = 0.0
    agrees_because: Text


class Scene(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A whole scene.

    Attributes:
        order: where it stands in the list.
        teaches: one line for the list.
        note: what to know before, including what this engine does that others do not.
        after: the question to answer after the run.
        view: what is drawn: left, bottom, right, top, in m.
        gravity: in m/s².
        step: of the simulation, in s; a run never uses another within one scene.
        iterations: of the contact solver.
        slop: how deep bodies may overlap before they are pushed apart, in m.
        duration: of a run without a view, in s.
        reverse: bodies are added to the engine in the opposite order; physics does not care, solvers do.
        seed: of ``jitter``.
        sets: formulas in parameters, by where the number goes: ``body.field``, ``body.velocity.0`` (an item
            of a pair, counted from 0), a joint's the same way, or a field of the scene.
    """

    format_version: int
    id: Name
    title: Text
    order: int
    teaches: Text
    note: Text
    after: Text
    view: tuple[Coordinate, Coordinate, Coordinate, Coordinate]
    gravity: tuple[Annotated[float, Meta(ge=-1000, le=1000)], Annotated[float, Meta(ge=-1000, le=1000)]]
    step: Annotated[float, Meta(ge=1e-5, le=0.1)] = 1 / 240
    iterations: Annotated[int, Meta(ge=1, le=1000)] = 20
    slop: Annotated[float, Meta(ge=0, le=1)] = 0.001
    duration: Annotated[float, Meta(gt=0, le=1e5)] = 5.0
    reverse: bool = False
    seed: Annotated[int, Meta(ge=0, le=10**9)] = 1
    floor: Floor | None = None
    material: Annotated[tuple[Material, ...], Meta(min_length=1)]
    body: Annotated[tuple[Body, ...], Meta(min_length=1)]
    joint: tuple[Joint, ...] = ()
    parameter: tuple[Parameter, ...] = ()
    sets: dict[str, Text] = {}
    probe: tuple[Probe, ...] = ()
    prediction: Prediction | None = None

    @property
    def materials(self) -> dict[str, Material]:
        return {material.name: material for material in self.material}

    @property
    def settings(self) -> dict[str, float]:
        """The settings that it begins with; restitution and friction are those of each body."""
        own = {"gravity": math.hypot(*self.gravity), "step": self.step, "iterations": float(self.iterations)}
        wheels = next((body.wheels for body in self.body if body.wheels), None)
        return own | {"left": wheels.left, "right": wheels.right} if wheels else own

    def pull(self, size: float) -> tuple[float, float]:
        """Gravity of this size in the scene's direction, in m/s²; downward where the scene has none."""
        gx, gy = self.gravity
        own = math.hypot(gx, gy)
        return (gx * size / own, gy * size / own) if own else (0.0, -size)


# ---
# A scene in numbers: every body with its position, outline, mass and moment of inertia.
#
# The world builds pymunk's bodies from these, and the exports write them into other engines' files, so that
# all of them start from the same numbers.


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
    shape: Form
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
    if shape == "box":
        body = Body(
            name=name, shape="box", material=material.name, size=(2 * size, 2 * size), velocity=velocity
        )
    else:
        body = Body(name=name, shape="circle", material=material.name, radius=size, velocity=velocity)
    return _part(body, material, name, place, PALETTE[sum(map(ord, name)) % len(PALETTE)])


def wall(name: str, a: Vector, b: Vector, half: float) -> Part:
    """A wall from ``a`` to ``b``, ``2 half`` m thick, that gives everything back and rubs a little."""
    body = Body(name=name, shape="segment", material="wall", points=(a, b), thickness=2 * half, fixed=True)
    return _part(body, Material(name="wall", restitution=1.0, friction=0.5), name, (0.0, 0.0), FIXED_COLOUR)


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
    points = body.points or ()
    match body.shape:
        case "circle":
            return (), body.radius or 0.0
        case "segment":
            return points, (body.thickness or 0.0) / 2
        case "box":
            width, height = body.size or (0.0, 0.0)
            w, h = width / 2, height / 2
            return ((-w, -h), (w, -h), (w, h), (-w, h)), 0.0
        case "polygon":
            return (points if signed_area(points) > 0 else points[::-1]), 0.0
        case _:
            assert_never(body.shape)


def _turned(x: float, y: float, angle: float) -> Vector:
    if angle == 0.0:
        return x, y
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


def signed_area(points: Sequence[Vector]) -> float:
    """Area of a polygon in m², positive if its corners run counter-clockwise."""
    return sum(cross for *_, cross in _sides(points)) / 2


def _sides(points: Sequence[Vector]) -> list[tuple[float, float, float, float, float]]:
    """Each side of a polygon: where it begins, where it ends, and the cross product of the two."""
    pairs = zip(points, [*points[1:], *points[:1]], strict=True)
    return [(x0, y0, x1, y1, x0 * y1 - x1 * y0) for (x0, y0), (x1, y1) in pairs]


def _centroid(points: Sequence[Vector]) -> Vector:
    sides = _sides(points)
    six = 3 * sum(cross for *_, cross in sides)
    x = sum((x0 + x1) * cross for x0, _, x1, _, cross in sides) / six
    y = sum((y0 + y1) * cross for _, y0, _, y1, cross in sides) / six
    return x, y


def _area(body: Body, outline: Sequence[Vector]) -> float:
    return math.pi * (body.radius or 0.0) ** 2 if body.shape == "circle" else signed_area(outline)


def _moment(body: Body, outline: Sequence[Vector], mass: float) -> float:
    """About the centre of mass. Source: any table of moments; the polygon's is the sum over its triangles."""
    if body.shape == "circle":
        return mass * (body.radius or 0.0) ** 2 / 2
    top = bottom = 0.0
    for x0, y0, x1, y1, cross in _sides(outline):
        top += cross * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1)
        bottom += cross
    return mass * top / (6 * bottom)

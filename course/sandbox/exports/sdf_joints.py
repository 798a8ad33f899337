"""How bodies are constrained in an SDF world: by rails that keep them in the plane, or by the scene's joints.

Gazebo's engine builds a model as a tree: each link is the child of one joint (gz-physics issue 25). So a body
that nothing holds slides on two rails, along x and along z, and turns on the second; what hangs from it, or
from the world, hangs by hinges, and a rod is a light link between two of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from course.errors import UsageError
from course.sandbox.exports.common import DEPTH

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from course.sandbox.scene.model import Joint
    from course.sandbox.scene.parts import Part

__all__ = ["Assembly", "LightLink", "SdfJoint", "assemblies"]

#: Mass of a rail and of a rod, as shares of what they carry: the motion changes by as much at most, and a
#: double still has ten digits of the sum.
_RAIL, _ROD = 1e-6, 1e-3


@dataclass(frozen=True, slots=True)
class LightLink:
    """An auxiliary link: a rail or a rod.

    Attributes:
        x, z, pitch: of its middle, m and rad.
        mass, moment: kg, and kg m² about each axis.
    """

    name: str
    x: float
    z: float
    pitch: float
    mass: float
    moment: float


@dataclass(frozen=True, slots=True)
class SdfJoint:
    """One joint of SDF.

    Attributes:
        kind: prismatic or revolute.
        parent, child: links of the model; the parent may be "world".
        axis: in the model's frame.
        place: of the joint in the child's frame, (x, z), m.
        speed: at the start, m/s or rad/s.
    """

    name: str
    kind: str
    parent: str
    child: str
    axis: tuple[int, int, int]
    place: tuple[float, float] = (0.0, 0.0)
    speed: float = 0.0


@dataclass(slots=True)
class Assembly:
    """One model: bodies connected by joints, with those joints and their auxiliary links."""

    bodies: list[Part] = field(default_factory=list)
    light: list[LightLink] = field(default_factory=list)
    held: list[SdfJoint] = field(default_factory=list)


def assemblies(parts: Sequence[Part], joints: Sequence[Joint]) -> Iterator[Assembly]:
    """The movable bodies of a scene as models, one for each connected group, in the scene's order.

    Raises:
        UsageError: joints close a chain.
    """
    by_name = {part.name: part for part in parts}
    left = dict.fromkeys(part.name for part in parts if not part.fixed)
    unused = list(joints)
    while left:
        made = Assembly()
        root = next(iter(left))
        for joint in unused:  # a group that hangs from the world begins where it does
            free = [name for name in (joint.a, joint.b) if name in left]
            if len(free) == 1 and _connected(root, free[0], unused, by_name):
                root = free[0]
                unused.remove(joint)
                _hang(made, joint, by_name, by_name[root])
                break
        else:
            _on_rails(made, by_name[root])
        del left[root]
        queue = [root]
        while queue:
            at = queue.pop(0)
            for joint in [joint for joint in unused if at in (joint.a, joint.b)]:
                unused.remove(joint)
                other = joint.b if joint.a == at else joint.a
                if other not in left:
                    raise UsageError(
                        f"The joint of {joint.a} and {joint.b} closes a chain; Gazebo holds only trees.",
                        help="Export the scene with --format mjcf, or a copy of it without that joint.",
                        code="cannot_export",
                    )
                _hang(made, joint, by_name, by_name[other])
                del left[other]
                queue.append(other)
        yield made


def _connected(a: str, b: str, joints: Sequence[Joint], parts: dict[str, Part]) -> bool:
    """Whether joints lead from one movable body to another without passing through a fixed one."""
    seen, queue = {a}, [a]
    while queue:
        at = queue.pop()
        for joint in joints:
            if at in (joint.a, joint.b):
                other = joint.b if joint.a == at else joint.a
                if other not in seen and not parts[other].fixed:
                    seen.add(other)
                    queue.append(other)
    return b in seen


def _on_rails(made: Assembly, body: Part) -> None:
    """Hold a body in the plane: two slides and, unless it must not turn, a hinge."""
    made.bodies.append(body)
    mass = _RAIL * body.mass
    turns = math.isfinite(body.moment)
    names = [f"{body.name}-rail-x", f"{body.name}-rail-z"] if turns else [f"{body.name}-rail-x"]
    made.light += [LightLink(name, body.x, body.y, 0.0, mass, mass * DEPTH**2) for name in names]
    chain = ["world", *names, body.name]
    joints = [("x", "prismatic", (1, 0, 0), body.vx), ("z", "prismatic", (0, 0, 1), body.vy)]
    if turns:
        joints.append(("turn", "revolute", (0, -1, 0), body.spin))
    made.held += [
        SdfJoint(f"{body.name}-{name}", kind, parent, child, axis, speed=speed)
        for (name, kind, axis, speed), parent, child in zip(joints, chain, chain[1:], strict=False)
    ]


def _hang(made: Assembly, joint: Joint, parts: dict[str, Part], body: Part) -> None:
    """Hang a body from a joint's other body, which is fixed or in the model already."""
    made.bodies.append(body)
    on_a = joint.a == body.name
    other = parts[joint.b if on_a else joint.a]
    near, far = (joint.anchor_a, joint.anchor_b) if on_a else (joint.anchor_b, joint.anchor_a)
    parent, rate = ("world", 0.0) if other.fixed else (other.name, other.spin)
    name, turn = f"{other.name}-{body.name}", (0, -1, 0)
    if joint.kind == "pivot":
        made.held.append(SdfJoint(name, "revolute", parent, body.name, turn, near, body.spin - rate))
        return
    (ax, az), (avx, avz) = _point(other, far)
    (bx, bz), (bvx, bvz) = _point(body, near)
    dx, dz = bx - ax, bz - az
    length = math.hypot(dx, dz)
    swing = (dx * (bvz - avz) - dz * (bvx - avx)) / length**2
    mass = _ROD * body.mass
    rod = f"rod-{name}"
    made.light.append(
        LightLink(rod, (ax + bx) / 2, (az + bz) / 2, math.atan2(dx, dz), mass, mass * length**2 / 12)
    )
    made.held += [
        SdfJoint(f"{rod}-top", "revolute", parent, rod, turn, (0.0, -length / 2), swing - rate),
        SdfJoint(f"{rod}-end", "revolute", rod, body.name, turn, near, body.spin - swing),
    ]


def _point(part: Part, anchor: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where a point of a body is at the start, m, and how fast it moves, m/s."""
    c, s = math.cos(part.angle), math.sin(part.angle)
    rx, rz = c * anchor[0] - s * anchor[1], s * anchor[0] + c * anchor[1]
    return (part.x + rx, part.y + rz), (part.vx - part.spin * rz, part.vy + part.spin * rx)

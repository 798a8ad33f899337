"""A scene as an SDF world, which Gazebo reads.

Bodies that joints hold together become links of one model, each other one a model of its own. SDF has
restitution and friction for each surface and leaves it to the physics engine how a pair's come about. It has
no plane to hold bodies in: they start in it, and nothing pushes them out of it but rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from course.sandbox.exports.common import DEPTH, checked_parts, gravity_of, moment_3d, number, surface_of

if TYPE_CHECKING:
    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.model import Joint
    from course.sandbox.scene.parts import Part

__all__ = ["VERSION", "sdf"]

VERSION = "1.9"
_NOTE = (
    " Written by `course sandbox export`. A plane in space: x is x, z is up, y is held by nothing."
    " Velocities at the start are in `state`, which some readers pass over. "
)


def sdf(chosen: Chosen) -> bytes:
    """The scene as an SDF file.

    Raises:
        UsageError: it holds something that has no counterpart.
    """
    scene = chosen.scene
    parts = checked_parts(chosen, "SDF")
    root = ET.Element("sdf", version=VERSION)
    root.append(ET.Comment(_NOTE))
    world = ET.SubElement(root, "world", name=scene.id)
    physics = ET.SubElement(world, "physics", name="fixed-step", type="ignored")
    _text(physics, "max_step_size", number(chosen.settings.get("step", scene.step)))
    _text(physics, "real_time_factor", "1")
    gx, gy = gravity_of(chosen)
    _text(world, "gravity", f"{number(gx)} 0 {number(gy)}")
    joined = {name for joint in scene.joint for name in (joint.a, joint.b)}
    by_name = {part.name: part for part in parts}
    if joined:
        model = ET.SubElement(world, "model", name="joined")
        _text(model, "self_collide", "true")
        for name in (part.name for part in parts if part.name in joined):
            _add_link(model, chosen, by_name[name], place=True)
            if by_name[name].fixed:
                _add_joint(model, f"{name}-stays", "fixed", "world", name)
        for i, joint in enumerate(scene.joint, 1):
            _add_held(model, i, joint, by_name)
    for part in parts:
        if part.name not in joined:
            model = ET.SubElement(world, "model", name=part.name)
            _text(model, "static", "true" if part.fixed else "false")
            _text(model, "pose", _pose(part))
            _add_link(model, chosen, part, place=False)
    _add_state(world, parts, joined)
    ET.indent(root)
    data: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return data + b"\n"


def _text(parent: ET.Element, tag: str, text: str) -> ET.Element:
    element = ET.SubElement(parent, tag)
    element.text = text
    return element


def _pose(part: Part) -> str:
    # Counter-clockwise, seen with x to the right and z up, is a turn about -y.
    return f"{number(part.x)} 0 {number(part.y)} 0 {number(-part.angle)} 0"


def _add_link(model: ET.Element, chosen: Chosen, part: Part, *, place: bool) -> None:
    link = ET.SubElement(model, "link", name=part.name)
    if place:
        _text(link, "pose", _pose(part))
    if not part.fixed:
        inertial = ET.SubElement(link, "inertial")
        _text(inertial, "mass", number(part.mass))
        inertia = ET.SubElement(inertial, "inertia")
        for tag, moment in zip(("ixx", "iyy", "izz"), moment_3d(part), strict=True):
            _text(inertia, tag, number(moment))
        for tag in ("ixy", "ixz", "iyz"):
            _text(inertia, tag, "0")
    restitution, friction = surface_of(chosen, part)
    for kind in ("collision", "visual"):
        element = ET.SubElement(link, kind, name=f"{part.name}-{kind}")
        if part.shape == "segment":
            (ax, ay), (bx, by) = part.outline
            tilt = math.atan2(bx - ax, by - ay)
            _text(element, "pose", f"{number((ax + bx) / 2)} 0 {number((ay + by) / 2)} 0 {number(tilt)} 0")
        elif part.shape == "polygon" and part.size is None:
            # An outline is drawn in x and y and raised along z; here it has to lie in x and z.
            _text(element, "pose", f"0 {number(DEPTH)} 0 {number(math.pi / 2)} 0 0")
        _add_geometry(ET.SubElement(element, "geometry"), part)
        if kind == "collision":
            surface = ET.SubElement(element, "surface")
            _text(ET.SubElement(surface, "bounce"), "restitution_coefficient", number(restitution))
            ode = ET.SubElement(ET.SubElement(surface, "friction"), "ode")
            _text(ode, "mu", number(friction))
            _text(ode, "mu2", number(friction))
        else:
            colour = " ".join(f"{int(part.colour[i : i + 2], 16) / 255:.3f}" for i in (1, 3, 5)) + " 1"
            material = ET.SubElement(element, "material")
            _text(material, "ambient", colour)
            _text(material, "diffuse", colour)


def _add_geometry(geometry: ET.Element, part: Part) -> None:
    if part.shape == "circle":
        _text(ET.SubElement(geometry, "sphere"), "radius", number(part.radius))
    elif part.shape == "segment":
        (ax, ay), (bx, by) = part.outline
        capsule = ET.SubElement(geometry, "capsule")
        _text(capsule, "radius", number(part.radius))
        _text(capsule, "length", number(math.hypot(bx - ax, by - ay)))
    elif part.size is not None:
        size = f"{number(part.size[0])} {number(2 * DEPTH)} {number(part.size[1])}"
        _text(ET.SubElement(geometry, "box"), "size", size)
    else:
        polyline = ET.SubElement(geometry, "polyline")
        for x, y in (*part.outline, part.outline[0]):
            _text(polyline, "point", f"{number(x)} {number(y)}")
        _text(polyline, "height", number(2 * DEPTH))


def _add_joint(model: ET.Element, name: str, kind: str, parent: str, child: str) -> ET.Element:
    joint = ET.SubElement(model, "joint", name=name, type=kind)
    _text(joint, "parent", parent)
    _text(joint, "child", child)
    if kind == "revolute":
        _text(ET.SubElement(joint, "axis"), "xyz", "0 1 0")
    return joint


def _add_held(model: ET.Element, number_of: int, joint: Joint, parts: dict[str, Part]) -> None:
    """A pivot is a hinge. A rod is a light link with a hinge at either end."""
    ends = [_end(parts[joint.a], joint.anchor_a), _end(parts[joint.b], joint.anchor_b)]
    if joint.kind == "pivot":
        made = _add_joint(model, f"pivot-{number_of}", "revolute", joint.a, joint.b)
        place = f"{number(joint.anchor_b[0])} 0 {number(joint.anchor_b[1])} 0 0 0"
        made.insert(0, _text(ET.Element("joint"), "pose", place))
        return
    name = f"rod-{number_of}"
    (ax, ay), (bx, by) = ends
    link = ET.SubElement(model, "link", name=name)
    tilt = math.atan2(bx - ax, by - ay)
    _text(link, "pose", f"{number((ax + bx) / 2)} 0 {number((ay + by) / 2)} 0 {number(tilt)} 0")
    length = math.hypot(bx - ax, by - ay)
    mass = 0.001 * max(parts[joint.a].mass, parts[joint.b].mass)
    inertial = ET.SubElement(link, "inertial")
    _text(inertial, "mass", number(mass))
    inertia = ET.SubElement(inertial, "inertia")
    for tag in ("ixx", "iyy", "izz"):
        _text(inertia, tag, number(mass * length * length / 12))
    for side, other, end in (("a", joint.a, -length / 2), ("b", joint.b, length / 2)):
        made = _add_joint(model, f"{name}-{side}", "revolute", other, name)
        made.insert(0, _text(ET.Element("joint"), "pose", f"0 0 {number(end)} 0 0 0"))


def _end(part: Part, anchor: tuple[float, float]) -> tuple[float, float]:
    c, s = math.cos(part.angle), math.sin(part.angle)
    return part.x + c * anchor[0] - s * anchor[1], part.y + s * anchor[0] + c * anchor[1]


def _add_state(world: ET.Element, parts: tuple[Part, ...], joined: set[str]) -> None:
    moving = [part for part in parts if not part.fixed and (part.vx or part.vy or part.spin)]
    if not moving:
        return
    state = ET.SubElement(world, "state", world_name=world.get("name", ""))
    for part in moving:
        model = ET.SubElement(state, "model", name="joined" if part.name in joined else part.name)
        link = ET.SubElement(model, "link", name=part.name)
        _text(link, "velocity", f"{number(part.vx)} 0 {number(part.vy)} 0 {number(-part.spin)} 0")

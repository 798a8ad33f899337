"""A scene as an SDF world, which Gazebo Sim reads.

Free bodies slide on rails and turn on a hinge, so that they stay in the plane; bodies connected by joints are
links of one model, and each other body is its own model. SDF has restitution and friction for each surface,
and the physics engine combines those of a pair. ``gazebo_start.py``, which must be in the world's folder,
sets the velocities at the start.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from course.sandbox.exports.common import DEPTH, checked_parts, gravity_of, moment_3d, number, surface_of
from course.sandbox.exports.sdf_joints import assemblies

if TYPE_CHECKING:
    from course.sandbox.exports.sdf_joints import Assembly, LightLink, SdfJoint
    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.parts import Part

__all__ = ["START", "VERSION", "sdf", "start_script"]

VERSION = "1.9"
#: The file that gives a world its velocities at the start.
START = "gazebo_start.py"
_NOTE = " Written by `course sandbox export`. A plane in space: x is x, z is up, y is held. "
_NOTE_START = (
    f" Velocities at the start are set by {START}, which Gazebo finds by GZ_SIM_SYSTEM_PLUGIN_PATH. "
)
#: The systems that Gazebo Sim loads when a world names none; a world that names one has to name them all.
_SYSTEMS = (
    ("physics", "Physics"),
    ("user-commands", "UserCommands"),
    ("scene-broadcaster", "SceneBroadcaster"),
)


def sdf(chosen: Chosen) -> bytes:
    """The scene as an SDF file.

    Raises:
        UsageError: it holds something that has no counterpart.
    """
    scene = chosen.scene
    parts = checked_parts(chosen, "SDF")
    models = list(assemblies(parts, scene.joint))
    root = ET.Element("sdf", version=VERSION)
    root.append(ET.Comment(_NOTE))
    if any(_moves(model) for model in models):
        root.append(ET.Comment(_NOTE_START))
    world = ET.SubElement(root, "world", name=scene.id)
    # Gazebo Sim takes its engine from a plugin, not from this type, which SDF wants to be there.
    physics = ET.SubElement(world, "physics", name="fixed-step", type="ignored")
    _text(physics, "max_step_size", number(chosen.settings.get("step", scene.step)))
    _text(physics, "real_time_factor", "1")
    for file, name in _SYSTEMS:
        _plugin(world, file, name)
    gx, gy = gravity_of(chosen)
    _text(world, "gravity", f"{number(gx)} 0 {number(gy)}")
    _add_light(world)
    for part in parts:
        if part.fixed:
            model = ET.SubElement(world, "model", name=part.name)
            _text(model, "static", "true")
            _add_link(model, chosen, part)
    for assembly in models:
        _add_assembly(world, chosen, assembly)
    ET.indent(root)
    data: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return data + b"\n"


def start_script(world: bytes) -> bytes | None:
    """The content of ``START``, a file beside the world; None if all its bodies start at rest."""
    if START.encode() not in world:
        return None
    return Path(__file__).with_name(START).read_bytes()


def _moves(assembly: Assembly) -> bool:
    return any(held.speed for held in assembly.held)


def _plugin(parent: ET.Element, file: str, name: str) -> ET.Element:
    return ET.SubElement(parent, "plugin", filename=f"gz-sim-{file}-system", name=f"gz::sim::systems::{name}")


def _add_light(world: ET.Element) -> None:
    light = ET.SubElement(world, "light", name="sun", type="directional")
    for tag, text in (
        ("cast_shadows", "true"),
        ("pose", "0 -10 10 0 0 0"),
        ("diffuse", "0.9 0.9 0.9 1"),
        ("specular", "0.2 0.2 0.2 1"),
        ("direction", "0.3 0.7 -0.6"),
    ):
        _text(light, tag, text)


def _add_assembly(world: ET.Element, chosen: Chosen, assembly: Assembly) -> None:
    """A model whose links stand where their bodies do, the joints that hold them, and their velocities."""
    model = ET.SubElement(world, "model", name=assembly.bodies[0].name)
    if len(assembly.bodies) > 1:
        _text(model, "self_collide", "true")
    for light in assembly.light:
        _add_light_link(model, light)
    for part in assembly.bodies:
        _add_link(model, chosen, part)
    for held in assembly.held:
        _add_joint(model, held)
    if _moves(assembly):
        plugin = _plugin(model, "python-system-loader", "PythonSystemLoader")
        _text(plugin, "module_name", START.removesuffix(".py"))
        moving = [held for held in assembly.held if held.speed]
        _text(plugin, "joints", " ".join(held.name for held in moving))
        for held in moving:
            _text(plugin, held.name, number(held.speed))


def _add_light_link(model: ET.Element, light: LightLink) -> None:
    link = ET.SubElement(model, "link", name=light.name)
    _text(link, "pose", f"{number(light.x)} 0 {number(light.z)} 0 {number(light.pitch)} 0")
    _add_inertial(link, light.mass, (light.moment,) * 3)


def _add_inertial(link: ET.Element, mass: float, moments: tuple[float, float, float]) -> None:
    inertial = ET.SubElement(link, "inertial")
    _text(inertial, "mass", number(mass))
    inertia = ET.SubElement(inertial, "inertia")
    for tag, moment in zip(("ixx", "iyy", "izz"), moments, strict=True):
        _text(inertia, tag, number(moment))
    for tag in ("ixy", "ixz", "iyz"):
        _text(inertia, tag, "0")


def _add_joint(model: ET.Element, held: SdfJoint) -> None:
    joint = ET.SubElement(model, "joint", name=held.name, type=held.kind)
    _text(joint, "pose", f"{number(held.place[0])} 0 {number(held.place[1])} 0 0 0")
    _text(joint, "parent", held.parent)
    _text(joint, "child", held.child)
    axis = ET.SubElement(joint, "axis")
    _text(axis, "xyz", " ".join(map(str, held.axis))).set("expressed_in", "__model__")
    limit = ET.SubElement(axis, "limit")
    _text(limit, "lower", "-1e16")  # SDF's own way to say that there is none
    _text(limit, "upper", "1e16")


def _text(parent: ET.Element, tag: str, text: str) -> ET.Element:
    element = ET.SubElement(parent, tag)
    element.text = text
    return element


def _pose(part: Part) -> str:
    # Counter-clockwise, seen with x to the right and z up, is a turn about -y.
    return f"{number(part.x)} 0 {number(part.y)} 0 {number(-part.angle)} 0"


def _add_link(model: ET.Element, chosen: Chosen, part: Part) -> None:
    link = ET.SubElement(model, "link", name=part.name)
    _text(link, "pose", _pose(part))
    if not part.fixed:
        _add_inertial(link, part.mass, moment_3d(part))
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

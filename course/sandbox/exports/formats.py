"""A scene as an SDF world, which Gazebo Sim reads.

Free bodies slide on rails and turn on a hinge, so that they stay in the plane; bodies connected by joints are
links of one model, and each other body is its own model. SDF has restitution and friction for each surface,
and the physics engine combines those of a pair. ``gazebo_start.py``, which must be in the world's folder,
sets the velocities at the start.
"""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, assert_never
from xml.etree import ElementTree as ET

from course.errors import UsageError
from course.sandbox.scene.loading import Chosen, surface_of
from course.sandbox.scene.model import Joint, Part, layout

# ---
# Shared by all exports: the plane becomes a vertical slice of space, and bodies get a depth.
#
# x stays x, y becomes z (up), and y, the third dimension, is held or left alone.


#: Half the depth of every body, in m, because bodies that are flat here need a depth there.
DEPTH = 0.05
#: Replaces an infinite moment of inertia, as a multiple of the mass, in m².
_NEVER_TURNS = 1e6


def checked_parts(chosen: Chosen, target: str) -> tuple[Part, ...]:
    """The bodies of a scene, if another engine can create all of them at the start.

    Raises:
        UsageError: some appear only later, or are driven by wheels.
    """
    parts = layout(chosen.scene)
    for part in parts:
        problem = "lets bodies in one by one" if part.appears else "drives on wheels" if part.wheels else ""
        if problem:
            raise UsageError(
                f"{chosen.scene.id} {problem}, and {target} describes only how a world begins.",
                help="Export another scene, or a copy of this one without that.",
                code="cannot_export",
            )
    return parts


def moment_3d(part: Part) -> tuple[float, float, float]:
    """Moments about x, about the axis out of the plane, and about z; in kg m².

    Only the middle one acts in the plane. Engines insist that none is larger than the other two together,
    which these never are.
    """
    turning = part.moment if math.isfinite(part.moment) else _NEVER_TURNS * part.mass
    across = turning / 2 + part.mass * DEPTH**2 / 3
    return across, turning, across


def number(value: float) -> str:
    """A float in the fewest digits that read back as the same float."""
    value = float(value) + 0.0  # no minus zero
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


# ---
# How bodies are constrained in an SDF world: by rails that keep them in the plane, or by the scene's joints.
#
# Gazebo's engine builds a model as a tree: each link is the child of one joint (gz-physics issue 25). So a
# body that nothing holds slides on two rails, along x and along z, and turns on the second; what hangs from
# it, or from the world, hangs by hinges, and a rod is a light link between two of them.


#: Mass of a rail and of a rod, as shares of what they carry: the motion changes by as much at most, and a
#: double still has ten digits of the sum.
_RAIL, _ROD = 1e-6, 1e-3


@dataclass(slots=True)
class Assembly:
    """One model: bodies connected by joints, with those joints and their auxiliary links, as elements.

    Attributes:
        light: the rails and the rods.
        speeds: of the joints that move at the start, by name, in m/s or rad/s.
    """

    bodies: list[Part] = field(default_factory=list)
    light: list[ET.Element] = field(default_factory=list)
    joints: list[ET.Element] = field(default_factory=list)
    speeds: dict[str, float] = field(default_factory=dict)

    def prop(self, name: str, place: tuple[float, float, float], mass: float, moment: float) -> None:
        """Add an auxiliary link.

        Args:
            place: x, z and pitch of its middle, in m and rad.
            mass, moment: in kg, and in kg m² about each axis.
        """
        link = ET.Element("link", name=name)
        _fill(link, {"pose": _pose(*place), "inertial": _inertial(mass, (moment,) * 3)})
        self.light.append(link)

    def hold(
        self,
        name: str,
        kind: str,
        links: tuple[str, str],
        *,
        axis: str = "0 -1 0",
        place: tuple[float, float] = (0.0, 0.0),
        speed: float,
    ) -> None:
        """Add a joint.

        Args:
            kind: prismatic or revolute.
            links: parent, which may be "world", and child.
            axis: in the model's frame.
            place: of the joint in the child's frame, x and z, in m.
            speed: at the start, in m/s or rad/s.
        """
        joint = ET.Element("joint", name=name, type=kind)
        none = {"lower": "-1e16", "upper": "1e16"}  # SDF's own way to say that there is no limit
        turning = {"xyz": axis, "limit": none}
        _fill(joint, {"pose": _pose(*place), "parent": links[0], "child": links[1], "axis": turning})
        for xyz in joint.iter("xyz"):
            xyz.set("expressed_in", "__model__")
        self.joints.append(joint)
        if speed:
            self.speeds[name] = speed


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
    for name in names:
        made.prop(name, (body.x, body.y, 0.0), mass, mass * DEPTH**2)
    chain = ["world", *names, body.name]
    made.hold(f"{body.name}-x", "prismatic", (chain[0], chain[1]), axis="1 0 0", speed=body.vx)
    made.hold(f"{body.name}-z", "prismatic", (chain[1], chain[2]), axis="0 0 1", speed=body.vy)
    if turns:
        made.hold(f"{body.name}-turn", "revolute", (chain[2], chain[3]), speed=body.spin)


def _hang(made: Assembly, joint: Joint, parts: dict[str, Part], body: Part) -> None:
    """Hang a body from a joint's other body, which is fixed or in the model already."""
    made.bodies.append(body)
    on_a = joint.a == body.name
    other = parts[joint.b if on_a else joint.a]
    near, far = (joint.anchor_a, joint.anchor_b) if on_a else (joint.anchor_b, joint.anchor_a)
    parent, rate = ("world", 0.0) if other.fixed else (other.name, other.spin)
    name = f"{other.name}-{body.name}"
    if joint.kind == "pivot":
        made.hold(name, "revolute", (parent, body.name), place=near, speed=body.spin - rate)
        return
    (ax, az), (avx, avz) = _point(other, far)
    (bx, bz), (bvx, bvz) = _point(body, near)
    dx, dz = bx - ax, bz - az
    length = math.hypot(dx, dz)
    swing = (dx * (bvz - avz) - dz * (bvx - avx)) / length**2
    mass = _ROD * body.mass
    rod = f"rod-{name}"
    made.prop(rod, ((ax + bx) / 2, (az + bz) / 2, math.atan2(dx, dz)), mass, mass * length**2 / 12)
    made.hold(f"{rod}-top", "revolute", (parent, rod), place=(0.0, -length / 2), speed=swing - rate)
    made.hold(f"{rod}-end", "revolute", (rod, body.name), place=near, speed=body.spin - swing)


def _point(part: Part, anchor: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where a point of a body is at the start, m, and how fast it moves, m/s."""
    c, s = math.cos(part.angle), math.sin(part.angle)
    rx, rz = c * anchor[0] - s * anchor[1], s * anchor[0] + c * anchor[1]
    return (part.x + rx, part.y + rz), (part.vx - part.spin * rz, part.vy + part.spin * rx)


VERSION = "1.9"
#: The file that gives a world its velocities at the start.
START = "gazebo_start.py"
_NOTE = " Written by `course sandbox export`. A plane in space: x is x, z is up, y is held. "
_NOTE_START = (
    f" Velocities at the start are set by {START}, which Gazebo finds by GZ_SIM_SYSTEM_PLUGIN_PATH. "
)
_SUN = {
    "cast_shadows": "true",
    "pose": "0 -10 10 0 0 0",
    "diffuse": "0.9 0.9 0.9 1",
    "specular": "0.2 0.2 0.2 1",
    "direction": "0.3 0.7 -0.6",
}
#: The systems that Gazebo Sim loads when a world names none; a world that names one has to name them all.
_SYSTEMS = ("physics", "user-commands", "scene-broadcaster")


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
    if any(model.speeds for model in models):
        root.append(ET.Comment(_NOTE_START))
    world = ET.SubElement(root, "world", name=scene.id)
    # Gazebo Sim takes its engine from a plugin, not from this type, which SDF wants to be there.
    physics = ET.SubElement(world, "physics", name="fixed-step", type="ignored")
    _fill(physics, {"max_step_size": chosen.present["step"], "real_time_factor": 1})
    for system in _SYSTEMS:
        _plugin(world, system)
    _fill(world, {"gravity": _gravity(chosen)})
    _fill(ET.SubElement(world, "light", name="sun", type="directional"), _SUN)
    for part in parts:
        if part.fixed:
            model = ET.SubElement(world, "model", name=part.name)
            _fill(model, {"static": "true"})
            _add_link(model, chosen, part)
    for assembly in models:
        _add_assembly(world, chosen, assembly)
    return _written(root)


def start_script(world: bytes) -> bytes | None:
    """The content of ``START``, a file beside the world; None if all its bodies start at rest."""
    if START.encode() not in world:
        return None
    return Path(__file__).with_name(START).read_bytes()


def _plugin(parent: ET.Element, system: str) -> ET.Element:
    name = f"gz::sim::systems::{system.title().replace('-', '')}"
    return ET.SubElement(parent, "plugin", filename=f"gz-sim-{system}-system", name=name)


def _add_assembly(world: ET.Element, chosen: Chosen, assembly: Assembly) -> None:
    """A model whose links stand where their bodies do, the joints that hold them, and their velocities."""
    model = ET.SubElement(world, "model", name=assembly.bodies[0].name)
    if len(assembly.bodies) > 1:
        _fill(model, {"self_collide": "true"})
    model.extend(assembly.light)
    for part in assembly.bodies:
        _add_link(model, chosen, part)
    model.extend(assembly.joints)
    if assembly.speeds:
        plugin = _plugin(model, "python-system-loader")
        joints = " ".join(assembly.speeds)
        _fill(plugin, {"module_name": START.removesuffix(".py"), "joints": joints, **assembly.speeds})


def _fill(parent: ET.Element, content: Mapping[str, Any]) -> None:
    """Add elements by their tags: with a text, a number, or more elements; a list has several of one tag."""
    for tag, values in content.items():
        for value in values if isinstance(values, list) else [values]:
            element = ET.SubElement(parent, tag)
            if isinstance(value, Mapping):
                _fill(element, value)
            else:
                element.text = value if isinstance(value, str) else number(value)


def _pose(x: float, z: float, pitch: float = 0.0) -> str:
    return f"{number(x)} 0 {number(z)} 0 {number(pitch)} 0"


def _inertial(mass: float, moments: tuple[float, float, float]) -> dict[str, Any]:
    inertia = dict(zip(("ixx", "iyy", "izz"), moments, strict=True)) | {"ixy": 0, "ixz": 0, "iyz": 0}
    return {"mass": mass, "inertia": inertia}


def _add_link(model: ET.Element, chosen: Chosen, part: Part) -> None:
    link = ET.SubElement(model, "link", name=part.name)
    # Counter-clockwise, seen with x to the right and z up, is a turn about -y.
    _fill(link, {"pose": _pose(part.x, part.y, -part.angle)})
    if not part.fixed:
        _fill(link, {"inertial": _inertial(part.mass, moment_3d(part))})
    restitution, friction = surface_of(chosen, part)
    rubbing = {"ode": {"mu": friction, "mu2": friction}}
    surface = {"bounce": {"restitution_coefficient": restitution}, "friction": rubbing}
    material = dict.fromkeys(("ambient", "diffuse"), _rgba(part.colour))
    for kind, more in (("collision", {"surface": surface}), ("visual", {"material": material})):
        _fill(ET.SubElement(link, kind, name=f"{part.name}-{kind}"), _shape(part) | more)


def _shape(part: Part) -> dict[str, Any]:
    """The geometry of a body, and its pose in the body's frame where it is not that frame."""
    match part.shape:
        case "circle":
            return {"geometry": {"sphere": {"radius": part.radius}}}
        case "segment":
            (ax, ay), (bx, by) = part.outline
            pose = _pose((ax + bx) / 2, (ay + by) / 2, math.atan2(bx - ax, by - ay))
            capsule = {"radius": part.radius, "length": math.hypot(bx - ax, by - ay)}
            return {"pose": pose, "geometry": {"capsule": capsule}}
        case "polygon" if part.size is not None:
            size = " ".join(map(number, (part.size[0], 2 * DEPTH, part.size[1])))
            return {"geometry": {"box": {"size": size}}}
        case "polygon":
            # An outline is drawn in x and y and raised along z; here it has to lie in x and z.
            pose = f"0 {number(DEPTH)} 0 {number(math.pi / 2)} 0 0"
            points = [f"{number(x)} {number(y)}" for x, y in (*part.outline, part.outline[0])]
            return {"pose": pose, "geometry": {"polyline": {"point": points, "height": 2 * DEPTH}}}
        case _:
            assert_never(part.shape)


# ---
# A scene as MJCF, MuJoCo's own format.
#
# Each movable body gets two slides and a hinge, which make a plane. MuJoCo has no coefficient of restitution:
# its contacts are springs with damping, and the damping is chosen so that one contact of two bodies rebounds
# as the scene says. It takes the larger friction of a pair where this engine multiplies, so every pair that
# can touch is listed with its own numbers.


_MJCF_NOTE = (
    " Written by `course sandbox export`. A plane in space: x is x, z is up, y is held. Velocities at the"
    " start are in the key frame `start`: load it with mj_resetDataKeyframe. "
)
#: Frequency of a contact's spring times the step: a contact lasts a dozen steps, which suits MuJoCo's solver.
_STIFF = 0.25
#: The weight of the spring against the solver in a contact; close to 1 is rigid.
_IMPEDANCE = "0.999 0.999 0.001"
_MOST_PAIRS = 5000


def mjcf(chosen: Chosen) -> bytes:
    """The scene as an MJCF file.

    Raises:
        UsageError: it holds something that has no counterpart, or too many pairs of bodies.
    """
    scene = chosen.scene
    parts = checked_parts(chosen, "MJCF")
    step = chosen.present["step"]
    root = ET.Element("mujoco", model=scene.id)
    root.append(ET.Comment(_MJCF_NOTE))
    ET.SubElement(root, "compiler", angle="radian", autolimits="true", inertiafromgeom="false")
    ET.SubElement(root, "option", timestep=number(step), gravity=_gravity(chosen), cone="elliptic")
    assets = ET.SubElement(root, "asset")
    world = ET.SubElement(root, "worldbody")
    bodies = {part.name: _add_body(world, assets, part) for part in parts}
    if scene.floor is not None:
        world.append(ET.Comment(" Seen from above: the floor's friction has no counterpart, bodies glide. "))
    _add_pairs(root, chosen, parts, step)
    _add_joints(root, bodies, scene.joint)
    _add_start(root, parts)
    return _written(root)


def damping_ratio(restitution: float) -> float:
    """The damping of a spring that returns a mass with this fraction of its speed, 0 to 1.

    Half a period of a damped spring leaves exp(-pi zeta / sqrt(1 - zeta²)) of the speed; solved for zeta.
    Source: Nagurka and Huang, "A mass-spring-damper model of a bouncing ball", 2004.
    """
    if restitution <= 0.0:
        return 1.0
    log = math.log(min(restitution, 1.0))
    return -log / math.hypot(math.pi, log)


def _add_body(world: ET.Element, assets: ET.Element, part: Part) -> ET.Element:
    body = ET.SubElement(world, "body", name=part.name, pos=f"{number(part.x)} 0 {number(part.y)}")
    # Counter-clockwise, seen with x to the right and z up, is a turn about -y.
    body.set("axisangle", f"0 -1 0 {number(part.angle)}")
    if not part.fixed:
        # Slides go along the world's axes, which in the body's frame are turned back.
        c, s = math.cos(part.angle), math.sin(part.angle)
        for axis, (ax, az) in (("x", (c, -s)), ("z", (s, c))):
            slide = ET.SubElement(body, "joint", name=f"{part.name}-{axis}", type="slide")
            slide.set("axis", f"{number(ax)} 0 {number(az)}")
        if math.isfinite(part.moment):
            ET.SubElement(body, "joint", name=f"{part.name}-turn", type="hinge", axis="0 -1 0")
        moments = " ".join(number(moment) for moment in moment_3d(part))
        ET.SubElement(body, "inertial", pos="0 0 0", mass=number(part.mass), diaginertia=moments)
    geom = ET.SubElement(body, "geom", name=part.name, contype="0", conaffinity="0", rgba=_rgba(part.colour))
    match part.shape:
        case "circle":
            # In the plane a sphere is a disc, and spheres touch in one point.
            geom.attrib |= {"type": "sphere", "size": number(part.radius)}
        case "segment":
            (ax, ay), (bx, by) = part.outline
            ends = " ".join(map(number, (ax, 0.0, ay, bx, 0.0, by)))
            geom.attrib |= {"type": "capsule", "size": number(part.radius), "fromto": ends}
        case "polygon" if part.size is not None:
            size = " ".join(map(number, (part.size[0] / 2, DEPTH, part.size[1] / 2)))
            geom.attrib |= {"type": "box", "size": size}
        case "polygon":
            corners = [(x, y, z) for y in (-DEPTH, DEPTH) for x, z in part.outline]
            vertices = " ".join(number(value) for corner in corners for value in corner)
            ET.SubElement(assets, "mesh", name=part.name, vertex=vertices)
            geom.attrib |= {"type": "mesh", "mesh": part.name}
        case _:
            assert_never(part.shape)
    return body


def _add_pairs(root: ET.Element, chosen: Chosen, parts: tuple[Part, ...], step: float) -> None:
    """Every pair that can touch, with the products of their restitution and friction."""
    apart = {frozenset((joint.a, joint.b)) for joint in chosen.scene.joint if not joint.touch}
    pairs = [
        (a, b)
        for a, b in itertools.combinations(parts, 2)
        if not (a.fixed and b.fixed) and frozenset((a.name, b.name)) not in apart
    ]
    if len(pairs) > _MOST_PAIRS:
        raise UsageError(
            f"{chosen.scene.id} has {len(pairs)} pairs that may touch; an export holds {_MOST_PAIRS}.",
            help="Export a scene with fewer bodies.",
            code="cannot_export",
        )
    contact = ET.SubElement(root, "contact")
    frequency = _STIFF / step
    for a, b in pairs:
        (e_a, mu_a), (e_b, mu_b) = surface_of(chosen, a), surface_of(chosen, b)
        sliding = max(mu_a * mu_b, 1e-5)  # zero is refused
        pair = ET.SubElement(contact, "pair", geom1=a.name, geom2=b.name, condim="3")
        pair.set("friction", f"{number(sliding)} {number(sliding)} 0.005 0.0001 0.0001")
        # Written with a minus sign: stiffness and damping themselves, per unit of mass.
        damping = 2.0 * damping_ratio(e_a * e_b) * frequency
        pair.set("solref", f"{number(-frequency * frequency)} {number(-max(damping, 1e-9))}")
        pair.set("solimp", _IMPEDANCE)


def _add_joints(root: ET.Element, bodies: dict[str, ET.Element], joints: tuple[Joint, ...]) -> None:
    """Rods are tendons that keep their length, pivots are connections."""
    if not joints:
        return
    tendons, equality = ET.SubElement(root, "tendon"), ET.SubElement(root, "equality")
    for i, joint in enumerate(joints, 1):
        if joint.kind == "pivot":
            place = f"{number(joint.anchor_a[0])} 0 {number(joint.anchor_a[1])}"
            ET.SubElement(equality, "connect", body1=joint.a, body2=joint.b, anchor=place)
            continue
        rod = ET.SubElement(tendons, "spatial", name=f"rod-{i}", width="0.005")
        for side, name, anchor in (("a", joint.a, joint.anchor_a), ("b", joint.b, joint.anchor_b)):
            site = f"rod-{i}-{side}"
            place = f"{number(anchor[0])} 0 {number(anchor[1])}"
            ET.SubElement(bodies[name], "site", name=site, pos=place, size="0.005")
            ET.SubElement(rod, "site", site=site)
        ET.SubElement(equality, "tendon", tendon1=f"rod-{i}", solref="0.005 1", solimp="0.99 0.999 0.001")


def _add_start(root: ET.Element, parts: tuple[Part, ...]) -> None:
    """Velocities at the start."""
    speeds: list[float] = []
    for part in parts:
        if not part.fixed:
            speeds += [part.vx, part.vy, *([part.spin] if math.isfinite(part.moment) else [])]
    frame = ET.SubElement(ET.SubElement(root, "keyframe"), "key", name="start")
    frame.set("qvel", " ".join(map(number, speeds)))


def _gravity(chosen: Chosen) -> str:
    gx, gy = chosen.scene.pull(chosen.present["gravity"])
    return f"{number(gx)} 0 {number(gy)}"


def _written(root: ET.Element) -> bytes:
    ET.indent(root)
    data: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return data + b"\n"


def _rgba(colour: str) -> str:
    return " ".join(f"{int(colour[i : i + 2], 16) / 255:.3f}" for i in (1, 3, 5)) + " 1"

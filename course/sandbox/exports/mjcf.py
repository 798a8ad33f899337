"""A scene as MJCF, MuJoCo's own format.

Each movable body gets two slides and a hinge, which make a plane. MuJoCo has no coefficient of restitution:
its contacts are springs with damping, and the damping is chosen so that one contact of two bodies rebounds as
the scene says. It takes the larger friction of a pair where this engine multiplies, so every pair that can
touch is listed with its own numbers.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from course.errors import UsageError
from course.sandbox.exports.common import DEPTH, checked_parts, gravity_of, moment_3d, number, surface_of

if TYPE_CHECKING:
    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.model import Joint
    from course.sandbox.scene.parts import Part

__all__ = ["damping_ratio", "mjcf"]

_NOTE = (
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
    step = chosen.settings.get("step", scene.step)
    gx, gy = gravity_of(chosen)
    root = ET.Element("mujoco", model=scene.id)
    root.append(ET.Comment(_NOTE))
    ET.SubElement(root, "compiler", angle="radian", autolimits="true", inertiafromgeom="false")
    ET.SubElement(
        root, "option", timestep=number(step), gravity=f"{number(gx)} 0 {number(gy)}", cone="elliptic"
    )
    assets = ET.SubElement(root, "asset")
    world = ET.SubElement(root, "worldbody")
    bodies = {part.name: _add_body(world, assets, part) for part in parts}
    if scene.floor is not None:
        world.append(ET.Comment(" Seen from above: the floor's friction has no counterpart, bodies glide. "))
    _add_pairs(root, chosen, parts, step)
    _add_joints(root, bodies, scene.joint)
    _add_start(root, parts)
    ET.indent(root)
    data: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return data + b"\n"


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
    if part.shape == "circle":
        # In the plane a sphere is a disc, and spheres touch in one point.
        geom.attrib |= {"type": "sphere", "size": number(part.radius)}
    elif part.shape == "segment":
        (ax, ay), (bx, by) = part.outline
        ends = " ".join(map(number, (ax, 0.0, ay, bx, 0.0, by)))
        geom.attrib |= {"type": "capsule", "size": number(part.radius), "fromto": ends}
    elif part.size is not None:
        size = " ".join(map(number, (part.size[0] / 2, DEPTH, part.size[1] / 2)))
        geom.attrib |= {"type": "box", "size": size}
    else:
        corners = [(x, y, z) for y in (-DEPTH, DEPTH) for x, z in part.outline]
        vertices = " ".join(number(value) for corner in corners for value in corner)
        ET.SubElement(assets, "mesh", name=part.name, vertex=vertices)
        geom.attrib |= {"type": "mesh", "mesh": part.name}
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


def _rgba(colour: str) -> str:
    return " ".join(f"{int(colour[i : i + 2], 16) / 255:.3f}" for i in (1, 3, 5)) + " 1"

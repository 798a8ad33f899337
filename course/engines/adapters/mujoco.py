"""MuJoCo: bodies in joint coordinates, contacts that are slightly soft.

It has no coefficient of restitution; how much a contact bounces is a damping ratio (``solref``). The friction
of two geoms is the larger of the two. The energy needs present velocities: after a step, MuJoCo's derived
quantities are still those at the beginning of the step, so ``motion`` updates them first.
"""

import functools
import math
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from course.engines.base import Motion, Scene


class EngineWorld:
    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self.model = mujoco.MjModel.from_xml_string(_xml(scene, options))
        self.data = mujoco.MjData(self.model)
        self._n = len(scene.bodies)
        if not scene.pivots:
            for index, body in enumerate(scene.bodies):
                self.data.qvel[6 * index : 6 * index + 3] = body.velocity
        mujoco.mj_forward(self.model, self.data)

    def step(self, n: int = 1) -> None:
        mujoco.mj_step(self.model, self.data, n)

    def motion(self) -> Motion:
        model, data = self.model, self.data
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        twist = np.zeros((self._n, 6))
        for index in range(self._n):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, index + 1, twist[index], 0)
        return Motion(data.xipos[1:].copy(), twist[:, 3:], twist[:, :3])

    def overlaps(self) -> list[float]:
        return [-float(contact.dist) for contact in self.data.contact if contact.dist <= 0.0]


def _xml(scene: Scene, options: Mapping[str, Any]) -> str:
    """The scene in MuJoCo's own language."""
    settings = {"timestep": repr(scene.dt), "gravity": _join(scene.gravity)}
    settings |= {key: str(options[key]) for key in ("integrator", "cone", "impratio") if key in options}
    contact = f'friction="{scene.friction!r}" {_contact(scene, options)}'
    collide = 'contype="0" conaffinity="0"' if scene.pivots else contact
    bodies, ends = [], ""
    for index, body in enumerate(scene.bodies):
        shape = "sphere" if body.shape == "ball" else "box"
        size = " ".join([repr(body.size)] * (1 if shape == "sphere" else 3))
        inertia = " ".join([repr(body.inertia)] * 3)
        parent = scene.bodies[index - 1].position if scene.pivots and index else (0.0, 0.0, 0.0)
        place = np.subtract(body.position, parent)
        joint = "<freejoint/>"
        if scene.pivots:
            pivot = np.subtract(scene.pivots[index], body.position)
            joint = f'<joint type="hinge" axis="0 1 0" pos="{_join(pivot)}"/>'
        bodies.append(
            f'<body pos="{_join(place)}">{joint}<inertial pos="0 0 0" mass="{body.mass!r}" '
            f'diaginertia="{inertia}"/><geom type="{shape}" size="{size}" {collide}/>'
        )
        if scene.pivots:
            ends += "</body>"
        else:
            bodies.append("</body>")
    fixed = [
        f'<geom type="box" pos="{_join(w.position)}" size="{_join(w.half)}" {contact}/>' for w in scene.walls
    ]
    if scene.floor:
        fixed.append(f'<geom type="plane" size="0 0 1" {contact}/>')
    option = " ".join(f'{key}="{value}"' for key, value in settings.items())
    flag = '<flag speculative="enable"/>' if options.get("speculative") else ""
    return (
        f"<mujoco><option {option}>{flag}</option>"
        f"<worldbody>{''.join(fixed)}{''.join(bodies)}{ends}</worldbody></mujoco>"
    )


def _contact(scene: Scene, options: Mapping[str, Any]) -> str:
    """The softness of a contact."""
    if options.get("stiff"):
        return f'solref="{2.0 * scene.dt!r} 1" solimp="0.99 0.99 0.001"'
    if "spring" not in options:
        return ""
    # A contact lasts about half a period of its spring, pi over the frequency: it must last several steps.
    stiffness = (options["spring"] / scene.dt) ** 2
    damping = 2.0 * damping_ratio(scene.restitution) * math.sqrt(stiffness)
    return f'solref="{-stiffness!r} {-damping!r}" solimp="0.99 0.99 0.001"'


@functools.cache
def damping_ratio(restitution: float) -> float:
    """The damping ratio with which a spring and a damper return a fraction of the speed.

    A contact cannot pull, so it ends when its force has dropped to zero, which is before the spring is
    relaxed: ln e = -(z / w) (pi - atan2(2 z w, w² - z²)) with w = sqrt(1 - z²), in units of the frequency.
    The formula without that end, e = exp(-pi z / w), returns too much of the ball's speed.

    Args:
        restitution: e, above 0.21 (there z is 1 / sqrt(2)) and up to 1.

    Source: T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465-469, equation for low damping; also
    arXiv 2204.10917.
    """
    low, high = 0.0, math.sqrt(0.5)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _given_back(middle) > restitution else (low, middle)
    return 0.5 * (low + high)


def _given_back(ratio: float) -> float:
    root = math.sqrt(1.0 - ratio**2)
    until_no_force = math.pi - math.atan2(2.0 * ratio * root, root**2 - ratio**2)
    return math.exp(-ratio / root * until_no_force)


def _join(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)

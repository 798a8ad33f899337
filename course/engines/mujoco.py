"""MuJoCo: bodies in joint coordinates, contacts that are slightly soft.

It has no coefficient of restitution; how much a contact bounces is a damping ratio (``solref``). Friction of
two geoms is the larger of the two. Energy needs velocities of the moment: after a step, MuJoCo's derived
quantities are still those of the step's beginning, so ``motion`` brings them up to date first.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from course.engines.base import AS_IT_COMES, Motion, Scene, Tuning

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["ADAPTER", "MujocoAdapter", "MujocoWorld"]

_SPRING = (
    "solref from the restitution: a contact is a spring and a damper here, and e = exp(-pi z / sqrt(1 - z²)) "
    "gives the damping ratio z (0.2155 for e = 0.5); solimp 0.99 makes it follow that spring."
)
_SOFT = "spring {}: its frequency in radians a step; {}."
_STAGES = "integrator RK4: looks at the spring of a contact four times a step."
_CONE = "cone elliptic: the default pyramid of friction gives way sooner across its corners."
_IMPRATIO = "impratio 100: friction as hard as the normal force, or a box at rest creeps downhill."
_RK4 = Tuning({"integrator": "RK4"}, ("integrator RK4: smooth motion without contacts is what it is for.",))
_GRIP = Tuning({"cone": "elliptic", "impratio": 100.0}, (_CONE, _IMPRATIO))
_STIFF = Tuning(
    {"stiff": True}, ("solref 2 steps, solimp 0.99: the stiffest contact that the step still resolves.",)
)
_TUNINGS = {
    "bounce": Tuning(
        {"spring": 0.3},
        (_SPRING + " " + _SOFT.format(0.3, "a contact then lasts ten steps, enough to resolve it"),),
    ),
    "small-drop": Tuning(
        {"spring": 0.5, "integrator": "RK4"},
        (
            _SPRING + " " + _SOFT.format(0.5, "stiffer, since a slow ball's weight presses the spring too"),
            _STAGES,
        ),
    ),
    "clash": Tuning(
        {"spring": 0.2, "integrator": "RK4"},
        (
            _SPRING + " " + _SOFT.format(0.2, "softer, since nothing presses and energy is what counts"),
            _STAGES,
        ),
    ),
    "slide": _GRIP,
    "stick": _GRIP,
    "diagonal": _GRIP,
    "pendulum": _RK4,
    "double-pendulum": _RK4,
    "stack": _STIFF,
    "mass-ratio": _STIFF,
    "boxes": _STIFF,
}


class MujocoWorld:
    """A scene as a MuJoCo model and its data."""

    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self.model = mujoco.MjModel.from_xml_string(_xml(scene, options))
        self.data = mujoco.MjData(self.model)
        self._n = len(scene.bodies)
        if not scene.pivots:
            for index, body in enumerate(scene.bodies):
                self.data.qvel[6 * index : 6 * index + 3] = body.velocity
        mujoco.mj_forward(self.model, self.data)

    def step(self, n: int = 1) -> None:
        """See ``World``."""
        mujoco.mj_step(self.model, self.data, n)

    def motion(self) -> Motion:
        """See ``World``."""
        model, data = self.model, self.data
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        twist = np.zeros((self._n, 6))
        for index in range(self._n):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, index + 1, twist[index], 0)
        return Motion(data.xipos[1:].copy(), twist[:, 3:], twist[:, :3])

    def contacts(self) -> tuple[int, float]:
        """See ``World``."""
        depths = [-float(contact.dist) for contact in self.data.contact if contact.dist <= 0.0]
        return len(depths), max(depths, default=0.0)


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
    return (
        f"<mujoco><option {option}/><worldbody>{''.join(fixed)}{''.join(bodies)}{ends}</worldbody></mujoco>"
    )


def _contact(scene: Scene, options: Mapping[str, Any]) -> str:
    """How a contact gives way."""
    if options.get("stiff"):
        return f'solref="{2.0 * scene.dt!r} 1" solimp="0.99 0.99 0.001"'
    if "spring" not in options:
        return ""
    # A contact lasts half a period of its spring, pi over the frequency: it must last several steps.
    stiffness = (options["spring"] / scene.dt) ** 2
    log = math.log(scene.restitution)
    ratio = -log / math.sqrt(math.pi**2 + log**2)
    damping = 2.0 * ratio * math.sqrt(stiffness)
    return f'solref="{-stiffness!r} {-damping!r}" solimp="0.99 0.99 0.001"'


def _join(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)


class MujocoAdapter:
    """See ``Adapter``."""

    def build(self, scene: Scene, options: Mapping[str, Any]) -> MujocoWorld:
        """See ``Adapter``."""
        return MujocoWorld(scene, options)

    def tuning(self, scenario: str) -> Tuning:
        """See ``Adapter``."""
        return _TUNINGS.get(scenario, AS_IT_COMES)


ADAPTER = MujocoAdapter()

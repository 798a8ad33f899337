"""PhysX 5 on the processor, through sapien; single precision.

Two materials' coefficients are averaged. By default contacts slower than 2 m/s do not bounce, the joints of
an articulation have friction, and its links are damped.
"""

import warnings
from typing import Any

import numpy as np

from course.engines.base import Body, Motion, Scene

with warnings.catch_warnings():
    # It looks for Vulkan, which draws; nothing is drawn here.
    warnings.simplefilter("ignore")
    import sapien
    from sapien import physx
from collections.abc import Mapping


class EngineWorld:
    """A scene in a PhysX system; nothing that draws is made."""

    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        config = physx.PhysxSceneConfig()
        config.gravity = np.array(scene.gravity, dtype=np.float32)
        config.bounce_threshold = options.get("bounce_threshold", config.bounce_threshold)
        physx.set_scene_config(config)
        self._iterations = options.get("iterations")
        self._offset = options.get("contact_offset")
        self.system = physx.PhysxCpuSystem()
        self.system.timestep = scene.dt
        self._sapien = sapien.Scene([self.system])
        self._material = physx.PhysxMaterial(scene.friction, scene.friction, scene.restitution)
        if scene.floor:
            self._fixed(physx.PhysxCollisionShapePlane(self._material), _FLOOR)
        for wall in scene.walls:
            half = np.array(wall.half, dtype=np.float32)
            shape = physx.PhysxCollisionShapeBox(half, self._material)
            self._fixed(shape, sapien.Pose(p=list(wall.position)))
        if scene.pivots:
            self.bodies = self._chain(scene, options)
        else:
            self.bodies = [self._add(body) for body in scene.bodies]

    def _fixed(self, shape: Any, pose: Any) -> None:
        part = physx.PhysxRigidStaticComponent()
        if self._offset:
            shape.contact_offset = self._offset
        part.attach(shape)
        self._enter(part, pose)

    def _enter(self, part: Any, pose: Any) -> Any:
        entity = sapien.Entity()
        entity.add_component(part)
        entity.set_pose(pose)
        self._sapien.add_entity(entity)
        return entity

    def _shape(self, body: Body) -> Any:
        if body.shape == "ball":
            return physx.PhysxCollisionShapeSphere(body.size, self._material)
        return physx.PhysxCollisionShapeBox(np.full(3, body.size, dtype=np.float32), self._material)

    def _add(self, body: Body) -> Any:
        part = physx.PhysxRigidDynamicComponent()
        shape = self._shape(body)
        if self._offset:
            shape.contact_offset = self._offset
        part.attach(shape)
        part.mass = body.mass
        part.inertia = np.full(3, body.inertia, dtype=np.float32)
        # A sleeping body costs nothing and does not drift, so the test would measure the sleep.
        part.sleep_threshold = 0.0
        if self._iterations:
            part.solver_position_iterations = self._iterations
        self._enter(part, sapien.Pose(p=list(body.position)))
        part.set_linear_velocity(list(body.velocity))
        return part

    def _chain(self, scene: Scene, options: Mapping[str, Any]) -> list[Any]:
        """An articulation. Its joints turn about their own x, so their frames are turned to the scene's y."""
        turned = [0.7071067811865476, 0.0, 0.0, 0.7071067811865476]
        root = physx.PhysxArticulationLinkComponent(None)
        entities = [self._link(root)]
        parent, base, links = root, (0.0, 0.0, 0.0), []
        for body, pivot in zip(scene.bodies, scene.pivots, strict=True):
            link = physx.PhysxArticulationLinkComponent(parent)
            link.mass = body.mass
            link.inertia = np.full(3, body.inertia, dtype=np.float32)
            entities.append(self._link(link))
            joint = link.joint
            joint.type = "revolute_unwrapped"
            joint.pose_in_parent = sapien.Pose(p=list(np.subtract(pivot, base)), q=turned)
            joint.pose_in_child = sapien.Pose(p=list(np.subtract(pivot, body.position)), q=turned)
            joint.limit = np.array([[-np.inf, np.inf]], dtype=np.float32)
            if "joint_friction" in options:
                joint.friction = options["joint_friction"]
            if "damping" in options:
                link.linear_damping = link.angular_damping = options["damping"]
            parent, base = link, body.position
            links.append(link)
        root.joint.type = "fixed"
        for entity in entities:
            self._sapien.add_entity(entity)
        root.articulation.set_qpos(np.zeros(len(links), dtype=np.float32))
        return links

    def _link(self, link: Any) -> Any:
        entity = sapien.Entity()
        entity.add_component(link)
        return entity

    def step(self, n: int = 1) -> None:
        step = self.system.step
        for _ in range(n):
            step()

    def motion(self) -> Motion:
        x = np.array([body.entity_pose.p for body in self.bodies], dtype=float)
        v = np.array([body.linear_velocity for body in self.bodies], dtype=float)
        w = np.array([body.angular_velocity for body in self.bodies], dtype=float)
        return Motion(x, v, w)

    def overlaps(self) -> list[float]:
        return [
            -point.separation
            for contact in self.system.get_contacts()
            for point in contact.points
            if point.separation <= 0.0
        ]


#: A plane's normal is its own x axis: turned up.
_FLOOR = sapien.Pose(q=[0.7071067811865476, 0.0, -0.7071067811865476, 0.0])

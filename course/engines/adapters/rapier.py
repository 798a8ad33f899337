"""Rapier: a recent engine in Rust, single precision, that divides every step into its own substeps (four).

It averages the coefficients of two materials by default, so equal ones act unchanged.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import rapier3d as rapier

from course.engines.base import Body, Motion, Scene


class EngineWorld:
    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self.world = world = rapier.PhysicsWorld(gravity=scene.gravity)
        parameters = world.integration_parameters
        parameters.dt = scene.dt
        if "substeps" in options:
            parameters.num_solver_iterations = options["substeps"]
        if "stiffness" in options:
            stiffness = options["stiffness"]
            parameters.contact_softness = rapier.SpringCoefficients(stiffness, 1.0)
            parameters.static_contact_softness = rapier.SpringCoefficients(2.0 * stiffness, 1.0)
        if "allowed_error" in options:
            parameters.normalized_allowed_linear_error = options["allowed_error"]
        if "foresight" in options:
            parameters.normalized_prediction_distance = options["foresight"]
        self._scene = scene
        self.handles = [self._add(body) for body in scene.bodies]
        if scene.floor:
            self._fixed(rapier.Collider.halfspace((0.0, 0.0, 1.0)), (0.0, 0.0, 0.0))
        for wall in scene.walls:
            self._fixed(rapier.Collider.cuboid(*wall.half), wall.position)
        if scene.pivots:
            self._chain(scene)

    def _material(self, collider: Any) -> Any:
        return collider.friction(self._scene.friction).restitution(self._scene.restitution)

    def _fixed(self, collider: Any, position: tuple[float, float, float]) -> None:
        self.world.add_collider(self._material(collider.translation(position)))

    def _add(self, body: Body) -> Any:
        builder = (
            rapier.RigidBodyBuilder(rapier.RigidBodyType.DYNAMIC)
            .translation(body.position)
            .linvel(body.velocity)
            .can_sleep(False)
        )
        shape = (
            rapier.Collider.ball(body.size)
            if body.shape == "ball"
            else rapier.Collider.cuboid(body.size, body.size, body.size)
        )
        collider = self._material(shape.mass(body.mass))
        if self._scene.pivots:
            collider = collider.collision_groups(rapier.InteractionGroups.none())
        return self.world.add_body(builder, [collider])

    def _chain(self, scene: Scene) -> None:
        world = self.world
        parent = world.add_body(rapier.RigidBodyBuilder(rapier.RigidBodyType.FIXED))
        base = (0.0, 0.0, 0.0)
        for handle, body, pivot in zip(self.handles, scene.bodies, scene.pivots, strict=True):
            joint = (
                rapier.RevoluteJointBuilder((0.0, 1.0, 0.0))
                .local_anchor1(tuple(np.subtract(pivot, base)))
                .local_anchor2(tuple(np.subtract(pivot, body.position)))
                .contacts_enabled(False)
                .build()
            )
            world.impulse_joints.insert(parent, handle, joint)
            parent, base = handle, body.position

    def step(self, n: int = 1) -> None:
        step = self.world.step
        for _ in range(n):
            step()

    def motion(self) -> Motion:
        get = self.world.rigid_bodies.get
        bodies = [get(handle) for handle in self.handles]
        x, v, w = (
            np.array([(one.x, one.y, one.z) for one in part])
            for part in (
                [body.translation for body in bodies],
                [body.linvel for body in bodies],
                [body.angvel for body in bodies],
            )
        )
        return Motion(x, v, w)

    def overlaps(self) -> list[float]:
        return [
            -point.dist
            for pair in self.world.narrow_phase.contact_pairs()
            for manifold in pair.manifolds
            for point in manifold.points
            if point.dist <= 0.0
        ]

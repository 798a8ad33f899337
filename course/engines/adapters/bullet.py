"""Bullet 2.84 as panda3d carries it: single precision, bodies with joints as constraints.

Restitutions and frictions of two bodies are multiplied. ``doPhysics`` has its own step, 1/60 s by default,
and interpolates in between. Here it takes the given time as one step (``max_substeps`` 0); otherwise its
results lag by up to a step.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from panda3d import bullet
from panda3d.core import BitMask32, ConfigVariableBool, ConfigVariableInt, NodePath, Point3, Vec3

from course.engines.base import Body, Motion, Scene

#: The package's own default.
_ITERATIONS = 10


class EngineWorld:
    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self._dt = scene.dt
        # A world reads them when it is created; the next one may need others.
        ConfigVariableInt("bullet-solver-iterations").setValue(options.get("iterations", _ITERATIONS))
        ConfigVariableBool("bullet-split-impulse").setValue(bool(options.get("split_impulse")))
        self.world = bullet.BulletWorld()
        self.world.setGravity(Vec3(*scene.gravity))
        self._root = NodePath("scene")
        self._ccd = bool(options.get("ccd"))
        self._contact_distance = options.get("contact_distance")
        # The product of two equal coefficients must be the one that acts.
        self._friction, self._restitution = math.sqrt(scene.friction), math.sqrt(scene.restitution)
        # Bodies of a chain share no group with any body, including themselves.
        self._mask = BitMask32.allOff() if scene.pivots else BitMask32.allOn()
        self.bodies = [self._add(body) for body in scene.bodies]
        if scene.floor:
            self._fixed(bullet.BulletPlaneShape(Vec3(0, 0, 1), 0), (0.0, 0.0, 0.0))
        for wall in scene.walls:
            self._fixed(bullet.BulletBoxShape(Vec3(*wall.half)), wall.position)
        for index, pivot in enumerate(scene.pivots):
            self._hinge(scene, index, pivot)

    def _node(self, shape: Any, position: tuple[float, float, float]) -> Any:
        node = bullet.BulletRigidBodyNode("body")
        node.addShape(shape)
        node.setFriction(self._friction)
        node.setRestitution(self._restitution)
        node.setIntoCollideMask(self._mask)
        self._root.attachNewNode(node).setPos(*position)
        return node

    def _fixed(self, shape: Any, position: tuple[float, float, float]) -> None:
        self.world.attach(self._node(shape, position))

    def _add(self, body: Body) -> Any:
        shape = (
            bullet.BulletSphereShape(body.size)
            if body.shape == "ball"
            else bullet.BulletBoxShape(Vec3(body.size, body.size, body.size))
        )
        node = self._node(shape, body.position)
        node.setMass(body.mass)
        node.setInertia(Vec3(body.inertia, body.inertia, body.inertia))
        # A sleeping body costs nothing and does not drift, so the test would measure the sleep.
        node.setDeactivationEnabled(False)
        node.setLinearVelocity(Vec3(*body.velocity))
        if self._contact_distance is not None:
            node.setContactProcessingThreshold(self._contact_distance)
        if self._ccd:
            node.setCcdMotionThreshold(0.5 * body.size)
            node.setCcdSweptSphereRadius(0.5 * body.size)
        self.world.attach(node)
        return node

    def _hinge(self, scene: Scene, index: int, pivot: tuple[float, float, float]) -> None:
        axis = Vec3(0, 1, 0)
        own = Point3(*np.subtract(pivot, scene.bodies[index].position))
        if index:
            other = Point3(*np.subtract(pivot, scene.bodies[index - 1].position))
            joint = bullet.BulletHingeConstraint(
                self.bodies[index - 1], self.bodies[index], other, own, axis, axis, True
            )
        else:
            joint = bullet.BulletHingeConstraint(self.bodies[0], own, axis, True)
        self.world.attach(joint)

    def step(self, n: int = 1) -> None:
        advance, dt = self.world.doPhysics, self._dt
        for _ in range(n):
            advance(dt, 0, dt)

    def motion(self) -> Motion:
        x = [tuple(node.getTransform().getPos()) for node in self.bodies]
        v = [tuple(node.getLinearVelocity()) for node in self.bodies]
        w = [tuple(node.getAngularVelocity()) for node in self.bodies]
        return Motion(np.array(x, dtype=float), np.array(v, dtype=float), np.array(w, dtype=float))

    def overlaps(self) -> list[float]:
        return [
            -point.getDistance()
            for manifold in self.world.getManifolds()
            for point in manifold.getManifoldPoints()
            if point.getDistance() <= 0.0
        ]

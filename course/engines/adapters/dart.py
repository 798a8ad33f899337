"""DART: jointed bodies in joint coordinates, contacts as one exact complementarity problem; double precision.

The restitutions of two bodies are multiplied; of two frictions the smaller one acts. Free bodies are jointed
too: each is a skeleton with a free joint.
"""

import math
from collections.abc import Mapping
from typing import Any

import dartpy as dart
import numpy as np

from course.engines.base import Body, Motion, Scene


class EngineWorld:
    """A scene as a DART world of skeletons."""

    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self.world = world = dart.simulation.World()
        world.setTimeStep(scene.dt)
        world.setGravity(list(scene.gravity))
        # A sleeping body costs nothing and does not drift, so the test would measure the sleep.
        sleep = world.getDeactivationOptions()
        sleep.mEnabled = False
        world.setDeactivationOptions(sleep)
        world.getConstraintSolver().setSplitImpulseEnabled(bool(options.get("split_impulse")))
        self._friction, self._restitution = scene.friction, math.sqrt(scene.restitution)
        if scene.floor:
            # A box: not every detector knows planes.
            self._fixed((0.0, 0.0, -1.0), (50.0, 50.0, 1.0))
        for wall in scene.walls:
            self._fixed(wall.position, wall.half)
        self.bodies = self._chain(scene) if scene.pivots else [self._add(body) for body in scene.bodies]

    def _surface(self, node: Any) -> None:
        surface = node.getDynamicsAspect()
        surface.setFrictionCoeff(self._friction)
        surface.setRestitutionCoeff(self._restitution)

    def _fixed(self, position: tuple[float, float, float], half: tuple[float, float, float]) -> None:
        skeleton = dart.dynamics.Skeleton(f"fixed {self.world.getNumSkeletons()}")
        joint, body = skeleton.createWeldJointAndBodyNodePair()
        place = dart.math.Isometry3()
        place.set_translation(list(position))
        joint.setTransformFromParentBodyNode(place)
        shape = dart.dynamics.BoxShape([2.0 * one for one in half])
        self._collides(body, shape)
        self.world.addSkeleton(skeleton)

    def _collides(self, body: Any, shape: Any) -> None:
        node = body.createShapeNode(shape)
        node.createCollisionAspect()
        node.createDynamicsAspect()
        self._surface(node)

    def _add(self, body: Body) -> Any:
        skeleton = dart.dynamics.Skeleton(f"body {self.world.getNumSkeletons()}")
        joint, node = skeleton.createFreeJointAndBodyNodePair()
        shape = (
            dart.dynamics.SphereShape(body.size)
            if body.shape == "ball"
            else dart.dynamics.BoxShape([2.0 * body.size] * 3)
        )
        self._collides(node, shape)
        node.setInertia(_inertia(body))
        # A free joint's coordinates: a rotation vector, then the place; and the same for velocities.
        joint.setPositions([0.0, 0.0, 0.0, *body.position])
        joint.setVelocities([0.0, 0.0, 0.0, *body.velocity])
        self.world.addSkeleton(skeleton)
        return node

    def _chain(self, scene: Scene) -> list[Any]:
        skeleton = dart.dynamics.Skeleton("chain")
        parent, base, links = None, (0.0, 0.0, 0.0), []
        for body, pivot in zip(scene.bodies, scene.pivots, strict=True):
            pair = (
                skeleton.createRevoluteJointAndBodyNodePair(parent)
                if parent
                else skeleton.createRevoluteJointAndBodyNodePair()
            )
            joint, node = pair
            joint.setAxis([0.0, 1.0, 0.0])
            above, below = dart.math.Isometry3(), dart.math.Isometry3()
            above.set_translation(np.subtract(pivot, base))
            below.set_translation(np.subtract(pivot, body.position))
            joint.setTransformFromParentBodyNode(above)
            joint.setTransformFromChildBodyNode(below)
            node.setInertia(_inertia(body))
            parent, base = node, body.position
            links.append(node)
        self.world.addSkeleton(skeleton)
        return links

    def step(self, n: int = 1) -> None:
        step = self.world.step
        for _ in range(n):
            step()

    def motion(self) -> Motion:
        x = np.array([node.getCOM() for node in self.bodies]).reshape(-1, 3)
        v = np.array([node.getCOMLinearVelocity() for node in self.bodies]).reshape(-1, 3)
        w = np.array([node.getAngularVelocity() for node in self.bodies]).reshape(-1, 3)
        return Motion(x, v, w)

    def overlaps(self) -> list[float]:
        found = self.world.getLastCollisionResult().getContacts()
        return [contact.penetrationDepth for contact in found]


def _inertia(body: Body) -> Any:
    return dart.dynamics.Inertia(body.mass, np.zeros(3), np.eye(3) * body.inertia)

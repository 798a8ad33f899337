"""PyBullet: Bullet 3 for robots, double precision, jointed bodies in joint coordinates.

Restitutions and frictions of two bodies are multiplied. By default every body is a multibody, and those are
damped like air, in their motion and in their spin: a speed v falls by 0.04 v (1 + v) a second. A joint of a
robot has a motor that holds it, which is switched off here.
"""

import itertools
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pybullet as p

from course.engines.base import Body, Motion, Scene


class EngineWorld:
    """A scene in its own physics server, without a window."""

    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self._scene = scene
        self._server = server = p.connect(p.DIRECT)
        if server < 0:
            raise RuntimeError("pybullet has no physics server left.")
        p.setTimeStep(scene.dt, physicsClientId=server)
        p.setGravity(*scene.gravity, physicsClientId=server)
        solver = {"numSolverIterations": options["iterations"]} if "iterations" in options else {}
        if "bounce_above" in options:
            solver["restitutionVelocityThreshold"] = options["bounce_above"]
        if "contact_erp" in options:
            solver["contactERP"] = options["contact_erp"]
        if solver:
            p.setPhysicsEngineParameter(**solver, physicsClientId=server)
        # The product of two equal coefficients must be the one that acts.
        self._surface = {
            "lateralFriction": math.sqrt(scene.friction),
            "restitution": math.sqrt(scene.restitution),
        }
        self._options = options
        if scene.floor:
            self._fixed(p.createCollisionShape(p.GEOM_PLANE, physicsClientId=server), (0.0, 0.0, 0.0))
        for wall in scene.walls:
            shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=wall.half, physicsClientId=server)
            self._fixed(shape, wall.position)
        self.parts = self._chain(scene) if scene.pivots else [(self._add(body), -1) for body in scene.bodies]

    def _fixed(self, shape: int, position: tuple[float, float, float]) -> None:
        made = p.createMultiBody(0, shape, basePosition=position, physicsClientId=self._server)
        p.changeDynamics(made, -1, **self._surface, physicsClientId=self._server)

    def _shape(self, body: Body) -> int:
        if body.shape == "ball":
            return int(p.createCollisionShape(p.GEOM_SPHERE, radius=body.size, physicsClientId=self._server))
        half = [body.size] * 3
        return int(p.createCollisionShape(p.GEOM_BOX, halfExtents=half, physicsClientId=self._server))

    def _add(self, body: Body) -> int:
        server = self._server
        made = int(
            p.createMultiBody(
                body.mass,
                self._shape(body),
                basePosition=body.position,
                useMaximalCoordinates=bool(self._options.get("ccd")),
                physicsClientId=server,
            )
        )
        p.resetBaseVelocity(made, body.velocity, (0.0, 0.0, 0.0), physicsClientId=server)
        self._set(made, -1, body)
        return made

    def _set(self, made: int, link: int, body: Body) -> None:
        extra: dict[str, Any] = {"localInertiaDiagonal": [body.inertia] * 3}
        if "damping" in self._options:
            extra |= {"linearDamping": self._options["damping"], "angularDamping": self._options["damping"]}
        if "contact_distance" in self._options:
            extra["contactProcessingThreshold"] = self._options["contact_distance"]
        if self._options.get("ccd"):
            extra["ccdSweptSphereRadius"] = 0.5 * body.size
        p.changeDynamics(made, link, **self._surface, **extra, physicsClientId=self._server)

    def _chain(self, scene: Scene) -> list[tuple[int, int]]:
        """One articulated body; a link's frame is at its hinge, away from its centre."""
        server, n = self._server, len(scene.bodies)
        hinges = [(0.0, 0.0, 0.0), *scene.pivots]
        made = p.createMultiBody(
            0,
            linkMasses=[body.mass for body in scene.bodies],
            linkCollisionShapeIndices=[-1] * n,
            linkVisualShapeIndices=[-1] * n,
            linkPositions=[list(np.subtract(b, a)) for a, b in itertools.pairwise(hinges)],
            linkOrientations=[[0, 0, 0, 1]] * n,
            linkInertialFramePositions=[
                list(np.subtract(body.position, pivot))
                for body, pivot in zip(scene.bodies, scene.pivots, strict=True)
            ],
            linkInertialFrameOrientations=[[0, 0, 0, 1]] * n,
            linkParentIndices=list(range(n)),
            linkJointTypes=[p.JOINT_REVOLUTE] * n,
            linkJointAxis=[[0, 1, 0]] * n,
            useMaximalCoordinates=False,
            physicsClientId=server,
        )
        damping = {"jointDamping": 0.0} if "damping" in self._options else {}
        for link, body in enumerate(scene.bodies):
            self._set(made, link, body)
            p.setJointMotorControl2(made, link, p.VELOCITY_CONTROL, force=0, physicsClientId=server)
            p.changeDynamics(made, link, **damping, physicsClientId=server)
        if damping:
            p.changeDynamics(made, -1, linearDamping=0.0, angularDamping=0.0, physicsClientId=server)
        return [(made, link) for link in range(n)]

    def step(self, n: int = 1) -> None:
        step, server = p.stepSimulation, self._server
        for _ in range(n):
            step(physicsClientId=server)

    def motion(self) -> Motion:
        x, v, w = [], [], []
        for body, link in self.parts:
            if link < 0:
                x.append(p.getBasePositionAndOrientation(body, physicsClientId=self._server)[0])
                linear, angular = p.getBaseVelocity(body, physicsClientId=self._server)
            else:
                state = p.getLinkState(
                    body,
                    link,
                    computeLinkVelocity=1,
                    computeForwardKinematics=1,
                    physicsClientId=self._server,
                )
                x.append(state[0])
                linear, angular = state[6], state[7]
            v.append(linear)
            w.append(angular)
        return Motion(np.array(x), np.array(v), np.array(w))

    def overlaps(self) -> list[float]:
        points = p.getContactPoints(physicsClientId=self._server) or ()
        return [-point[8] for point in points if point[8] <= 0.0]

    def __del__(self) -> None:
        if p is not None and p.isConnected(self._server):
            p.disconnect(self._server)

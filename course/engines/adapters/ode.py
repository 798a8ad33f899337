"""ODE, as panda3d carries it: single precision, stepped with its iterative solver (``quickStep``).

Contacts are joints that exist for one step; ``autoCollide`` makes them without going through Python. Friction
acts as a pyramid that scales with the normal force. With an almost zero constraint force mixing, the single
precision solver divides by zero and ends the process, so it stays at ODE's own default.

An exception inside a callback of panda3d is printed and dropped; the one callback here cannot fail.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from panda3d import ode
from panda3d.core import Quat, Vec4

from course.engines.base import Body, Motion, Scene

#: The maximum number of points between two bodies; two cubes face to face have at most eight.
_POINTS = 8


class EngineWorld:
    """A scene as an ODE world with a collision space."""

    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        self._dt = scene.dt
        # quickStep shuffles the order of its constraints with a generator that the whole process shares.
        ode.OdeUtil.randSetSeed(0)
        self.world = world = ode.OdeWorld()
        world.setGravity(*scene.gravity)
        if "erp" in options:
            world.setErp(options["erp"])
        if "iterations" in options:
            world.setQuickStepNumIterations(options["iterations"])
        self._advance = world.step if options.get("exact") else world.quickStep
        self.space = ode.OdeHashSpace()
        self._joints_of_contacts = ode.OdeJointGroup()
        self.space.setAutoCollideWorld(world)
        self.space.setAutoCollideJointGroup(self._joints_of_contacts)
        world.initSurfaceTable(1)
        # Two surfaces, friction, restitution, the speed below which nothing bounces, then how hard a contact
        # is (the world's own values), slip and damping.
        cfm = options.get("contact_cfm", world.getCfm())
        world.setSurfaceEntry(0, 0, scene.friction, scene.restitution, 0.0, world.getErp(), cfm, 0.0, 0.0)
        self._geoms: list[Any] = []
        self.bodies = [self._add(body, collides=not scene.pivots) for body in scene.bodies]
        if scene.floor:
            self._geoms.append(ode.OdePlaneGeom(self.space, Vec4(0, 0, 1, 0)))
        for wall in scene.walls:
            geom = ode.OdeBoxGeom(self.space, *(2.0 * half for half in wall.half))
            geom.setPosition(*wall.position)
            self._geoms.append(geom)
        self._hinges = [self._hinge(index, pivot) for index, pivot in enumerate(scene.pivots)]

    def _add(self, body: Body, *, collides: bool) -> Any:
        made = ode.OdeBody(self.world)
        mass = ode.OdeMass()
        edge = 2.0 * body.size
        if body.shape == "ball":
            mass.setSphereTotal(body.mass, body.size)
        else:
            mass.setBoxTotal(body.mass, edge, edge, edge)
        made.setMass(mass)
        made.setPosition(*body.position)
        made.setQuaternion(Quat.identQuat())
        made.setLinearVel(*body.velocity)
        if collides:
            geom = (
                ode.OdeSphereGeom(self.space, body.size)
                if body.shape == "ball"
                else ode.OdeBoxGeom(self.space, edge, edge, edge)
            )
            geom.setBody(made)
            self._geoms.append(geom)
        return made

    def _hinge(self, index: int, pivot: tuple[float, float, float]) -> Any:
        joint = ode.OdeHingeJoint(self.world)
        if index:
            joint.attachBodies(self.bodies[index - 1], self.bodies[index])
        else:
            joint.attachBody(self.bodies[0], 0)
        joint.setAnchor(*pivot)
        joint.setAxis(0, 1, 0)
        return joint

    def step(self, n: int = 1) -> None:
        collide, advance, dt = self.space.autoCollide, self._advance, self._dt
        empty = self._joints_of_contacts.empty
        for _ in range(n):
            collide()
            advance(dt)
            empty()

    def motion(self) -> Motion:
        x, v, w = (
            np.array([tuple(read(body)) for body in self.bodies], dtype=float)
            for read in (ode.OdeBody.getPosition, ode.OdeBody.getLinearVel, ode.OdeBody.getAngularVel)
        )
        return Motion(x, v, w)

    def overlaps(self) -> list[float]:
        """See ``World``; searched again, at the present positions."""
        depths: list[float] = []

        def look(_arg: Any, one: Any, other: Any) -> None:
            found = ode.OdeUtil.collide(one, other, _POINTS)
            depths.extend(found.getContactGeom(i).getDepth() for i in range(found.getNumContacts()))

        self.space.collide(None, look)
        return depths

"""pymunk: Chipmunk, an engine in the plane. x and z of a scene are its x and y.

Its defaults are made for worlds measured in pixels: bodies may overlap by 0.1 units before they are pushed
apart. Friction and restitution of two shapes are multiplied.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pymunk

from course.engines.base import Body, Motion, NotApplicableError, Scene, Wall


class EngineWorld:
    def __init__(self, scene: Scene, options: Mapping[str, Any]) -> None:
        if scene.gravity[1] or any(body.velocity[1] for body in scene.bodies):
            raise NotApplicableError("The engine knows two dimensions only.")
        self._dt = scene.dt
        self.space = space = pymunk.Space()
        space.gravity = scene.gravity[::2]  # x and z
        space.iterations = options.get("iterations", space.iterations)
        space.collision_slop = options.get("collision_slop", space.collision_slop)
        # The product of two equal coefficients must be the one that acts.
        self._friction, self._restitution = math.sqrt(scene.friction), math.sqrt(scene.restitution)
        self._chain = bool(scene.pivots)
        self.bodies = [self._add(body) for body in scene.bodies]
        if scene.floor:
            self._fixed(pymunk.Poly(space.static_body, [(-50, -1), (50, -1), (50, 0), (-50, 0)]))
        for wall in scene.walls:
            self._wall(wall)
        for index, pivot in enumerate(scene.pivots):
            parent = self.bodies[index - 1] if index else space.static_body
            joint = pymunk.PivotJoint(parent, self.bodies[index], pivot[::2])
            joint.error_bias = options.get("error_bias", joint.error_bias)
            space.add(joint)

    def _add(self, body: Body) -> pymunk.Body:
        made = pymunk.Body(body.mass, body.inertia)
        made.position, made.velocity = body.position[::2], body.velocity[::2]
        edge = 2.0 * body.size
        shape = (
            pymunk.Circle(made, body.size)
            if body.shape == "ball"
            else pymunk.Poly.create_box(made, (edge, edge))
        )
        shape.friction, shape.elasticity = self._friction, self._restitution
        if self._chain:
            shape.filter = pymunk.ShapeFilter(group=1)
        self.space.add(made, shape)
        return made

    def _wall(self, wall: Wall) -> None:
        x, z = wall.position[0], wall.position[2]
        a, c = wall.half[0], wall.half[2]
        corners = [(x - a, z - c), (x + a, z - c), (x + a, z + c), (x - a, z + c)]
        self._fixed(pymunk.Poly(self.space.static_body, corners))

    def _fixed(self, shape: pymunk.Shape) -> None:
        shape.friction, shape.elasticity = self._friction, self._restitution
        self.space.add(shape)

    def step(self, n: int = 1) -> None:
        step, dt = self.space.step, self._dt
        for _ in range(n):
            step(dt)

    def motion(self) -> Motion:
        x = np.array([(b.position.x, 0.0, b.position.y) for b in self.bodies])
        v = np.array([(b.velocity.x, 0.0, b.velocity.y) for b in self.bodies])
        w = np.array([(0.0, -b.angular_velocity, 0.0) for b in self.bodies])
        return Motion(x, v, w)

    def overlaps(self) -> list[float]:
        points: dict[Any, float] = {}

        def note(arbiter: pymunk.Arbiter) -> None:
            for i, point in enumerate(arbiter.contact_point_set.points):
                points[(*arbiter.shapes, i)] = point.distance

        for body in self.bodies:
            body.each_arbiter(note)
        return [-distance for distance in points.values() if distance <= 0.0]

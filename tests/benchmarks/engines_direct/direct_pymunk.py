"""pymunk through its own interface, in the plane: x and z of a scene are its x and y.

Two shapes' frictions and elasticities are multiplied, so each gets the root of what is to act.
"""

import math

import measures
import pymunk

SLOP = {"collision_slop": 1e-4}
WELL_SET = {"bounce": SLOP, "small-drop": SLOP, "mass-ratio": {"iterations": 100}}
#: What one option does, beyond the tests as they come and well set.
EXTRA = {"1000 iterations": ("mass-ratio", {"iterations": 1000, **SLOP})}


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings`` are attributes of a Space."""
    space = pymunk.Space()
    space.gravity = (gravity[0], gravity[2])
    for name, value in settings.items():
        setattr(space, name, value)

    def with_surface(shape):
        shape.friction, shape.elasticity = math.sqrt(friction), math.sqrt(restitution)
        return shape

    made = []
    for kind, size, mass, place, velocity in bodies:
        body = pymunk.Body(mass, measures.inertia(kind, size, mass))
        body.position, body.velocity = (place[0], place[2]), (velocity[0], velocity[2])
        ball = kind == "ball"
        shape = pymunk.Circle(body, size) if ball else pymunk.Poly.create_box(body, (2 * size, 2 * size))
        space.add(body, with_surface(shape))
        made.append(body)
    if floor:
        corners = [(-50, -1), (50, -1), (50, 0), (-50, 0)]
        space.add(with_surface(pymunk.Poly(space.static_body, corners)))

    def read(i):
        x, v = made[i].position, made[i].velocity
        return (x.x, 0.0, x.y), (v.x, 0.0, v.y)

    return lambda: space.step(measures.STEP), read


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

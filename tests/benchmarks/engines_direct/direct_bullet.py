"""Bullet 2.84 through panda3d's own interface to it.

Two bodies' frictions and restitutions are multiplied, so each gets the root of what is to act.
``doPhysics(dt, 0, dt)`` takes dt as one step; ``doPhysics(dt)`` alone steps by 1/60 s and interpolates.
"""

import math

import measures
from panda3d import bullet
from panda3d.core import ConfigVariableBool, ConfigVariableInt, NodePath, Vec3

NEAR = {"contact_distance": 0.0}
WELL_SET = {"small-drop": NEAR, "mass-ratio": {"split_impulse": True}}
EXTRA = {
    "doPhysics(dt), a step of 1/60 s inside": ("slide", {"own_step": True}),
    "100 iterations": ("mass-ratio", {"iterations": 100}),
    "1000 iterations": ("mass-ratio", {"iterations": 1000}),
    "contacts only where bodies touch": ("bounce", NEAR),
    "split impulse": ("clash", {"split_impulse": True}),
}


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings``: iterations, split_impulse, contact_distance, own_step."""
    ConfigVariableInt("bullet-solver-iterations").setValue(settings.get("iterations", 10))
    ConfigVariableBool("bullet-split-impulse").setValue(settings.get("split_impulse", False))
    world, root = bullet.BulletWorld(), NodePath("scene")
    world.setGravity(Vec3(*gravity))

    def node(shape, place):
        made = bullet.BulletRigidBodyNode("body")
        made.addShape(shape)
        made.setFriction(math.sqrt(friction))
        made.setRestitution(math.sqrt(restitution))
        root.attachNewNode(made).setPos(*place)
        return made

    made = []
    for kind, size, mass, place, velocity in bodies:
        ball = kind == "ball"
        shape = bullet.BulletSphereShape(size) if ball else bullet.BulletBoxShape(Vec3(size, size, size))
        body = node(shape, place)
        body.setMass(mass)
        body.setDeactivationEnabled(False)
        body.setLinearVelocity(Vec3(*velocity))
        if "contact_distance" in settings:
            body.setContactProcessingThreshold(settings["contact_distance"])
        world.attach(body)
        made.append(body)
    if floor:
        world.attach(node(bullet.BulletPlaneShape(Vec3(0, 0, 1), 0), (0, 0, 0)))
    how = () if settings.get("own_step") else (0, measures.STEP)

    def read(i):
        return tuple(made[i].getTransform().getPos()), tuple(made[i].getLinearVelocity())

    return lambda: world.doPhysics(measures.STEP, *how), read


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

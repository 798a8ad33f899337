"""DART through dartpy. Two bodies' restitutions are multiplied; of their frictions the smaller one acts."""

import math

import dartpy as dart
import measures
import numpy as np

WELL_SET: dict[str, dict] = {}
EXTRA = {
    "split impulse": ("mass-ratio", {"split_impulse": True}),
    "Bullet finds the contacts": ("bounce", {"detector": dart.collision.BulletCollisionDetector}),
}


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings``: split_impulse, detector."""
    world = dart.simulation.World()
    world.setTimeStep(measures.STEP)
    world.setGravity(list(gravity))
    sleep = world.getDeactivationOptions()
    sleep.mEnabled = False
    world.setDeactivationOptions(sleep)
    solver = world.getConstraintSolver()
    solver.setSplitImpulseEnabled(settings.get("split_impulse", False))
    if "detector" in settings:
        solver.setCollisionDetector(settings["detector"]())

    def with_shape(body, shape):
        node = body.createShapeNode(shape)
        node.createCollisionAspect()
        node.createDynamicsAspect()
        node.getDynamicsAspect().setFrictionCoeff(friction)
        node.getDynamicsAspect().setRestitutionCoeff(math.sqrt(restitution))

    made = []
    for i, (kind, size, mass, place, velocity) in enumerate(bodies):
        skeleton = dart.dynamics.Skeleton(f"body {i}")
        joint, body = skeleton.createFreeJointAndBodyNodePair()
        ball = kind == "ball"
        with_shape(body, dart.dynamics.SphereShape(size) if ball else dart.dynamics.BoxShape([2 * size] * 3))
        moment = np.eye(3) * measures.inertia(kind, size, mass)
        body.setInertia(dart.dynamics.Inertia(mass, np.zeros(3), moment))
        joint.setPositions([0, 0, 0, *place])
        joint.setVelocities([0, 0, 0, *velocity])
        world.addSkeleton(skeleton)
        made.append(body)
    if floor:
        skeleton = dart.dynamics.Skeleton("floor")
        joint, body = skeleton.createWeldJointAndBodyNodePair()
        down = dart.math.Isometry3()
        down.set_translation([0, 0, -1.0])
        joint.setTransformFromParentBodyNode(down)
        with_shape(body, dart.dynamics.BoxShape([100, 100, 2]))
        world.addSkeleton(skeleton)

    def read(i):
        return tuple(np.ravel(made[i].getCOM())), tuple(np.ravel(made[i].getCOMLinearVelocity()))

    return world.step, read


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

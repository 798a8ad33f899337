"""Bullet 3 through PyBullet.

Two bodies' frictions and restitutions are multiplied, so each gets the root of what is to act.
"""

import math

import measures
import pybullet as p

NO_AIR = {"linearDamping": 0.0, "angularDamping": 0.0}
NEAR = {"contactProcessingThreshold": 0.0}
NO_PUSH = {"contactERP": 0.0}
WELL_SET = {
    "free-fall": NO_AIR,
    "bounce": NO_AIR | NO_PUSH | NEAR,
    "small-drop": NO_PUSH | NEAR,
    "clash": NO_AIR | NO_PUSH,
    "slide": NO_AIR,
    "mass-ratio": {"numSolverIterations": 100},
}
EXTRA = {
    "no air, error correction left on": ("clash", NO_AIR),
    "no air, contacts foreseen": ("small-drop", NO_AIR | {"restitutionVelocityThreshold": 0.0}),
    "no air, contacts only where bodies touch": (
        "small-drop", NO_AIR | {"restitutionVelocityThreshold": 0.0} | NEAR,
    ),
    "1000 iterations": ("mass-ratio", NO_AIR | {"numSolverIterations": 1000}),
}  # fmt: skip
#: Of the settings, those that belong to a body; the rest belong to the engine.
OF_A_BODY = ("linearDamping", "angularDamping", "contactProcessingThreshold")


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings`` are arguments of changeDynamics or setPhysicsEngineParameter."""
    if p.isConnected():
        # A fresh server: what was set for the last scene must not last.
        p.disconnect()
    p.connect(p.DIRECT)
    p.setTimeStep(measures.STEP)
    p.setGravity(*gravity)
    of_body = {name: value for name, value in settings.items() if name in OF_A_BODY}
    of_engine = {name: value for name, value in settings.items() if name not in OF_A_BODY}
    if of_engine:
        p.setPhysicsEngineParameter(**of_engine)
    surface = {"lateralFriction": math.sqrt(friction), "restitution": math.sqrt(restitution)}
    if floor:
        p.changeDynamics(p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE)), -1, **surface)
    made = []
    for kind, size, mass, place, velocity in bodies:
        ball = kind == "ball"
        shape = (
            p.createCollisionShape(p.GEOM_SPHERE, radius=size)
            if ball
            else p.createCollisionShape(p.GEOM_BOX, halfExtents=[size] * 3)
        )
        body = p.createMultiBody(mass, shape, basePosition=place)
        inertia = [measures.inertia(kind, size, mass)] * 3
        p.changeDynamics(body, -1, localInertiaDiagonal=inertia, **surface, **of_body)
        p.resetBaseVelocity(body, velocity, (0, 0, 0))
        made.append(body)

    def read(i):
        return p.getBasePositionAndOrientation(made[i])[0], p.getBaseVelocity(made[i])[0]

    return p.stepSimulation, read


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

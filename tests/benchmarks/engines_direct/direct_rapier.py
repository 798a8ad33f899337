"""Rapier through its own Python package. Of two coefficients the average acts: equal ones act as they are."""

import measures
import rapier3d as rapier

WELL_SET = {
    "bounce": {"num_solver_iterations": 100},
    "small-drop": {"num_solver_iterations": 100},
    "mass-ratio": {"num_solver_iterations": 100, "contact_softness": 3000.0},
}
EXTRA = {
    "16 substeps": ("free-fall", {"num_solver_iterations": 16}),
    "100 substeps, contacts as soft as they come": ("mass-ratio", {"num_solver_iterations": 100}),
}


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings`` are integration parameters, contact_softness a frequency in Hz."""
    world = rapier.PhysicsWorld(gravity=tuple(map(float, gravity)))
    parameters = world.integration_parameters
    parameters.dt = measures.STEP
    for name, value in settings.items():
        if name == "contact_softness":
            parameters.contact_softness = rapier.SpringCoefficients(value, 1.0)
            parameters.static_contact_softness = rapier.SpringCoefficients(2 * value, 1.0)
        else:
            setattr(parameters, name, value)
    made = []
    for kind, size, mass, place, velocity in bodies:
        builder = rapier.RigidBodyBuilder(rapier.RigidBodyType.DYNAMIC)
        builder = builder.translation(tuple(map(float, place))).linvel(tuple(map(float, velocity)))
        ball = kind == "ball"
        shape = rapier.Collider.ball(size) if ball else rapier.Collider.cuboid(size, size, size)
        collider = shape.mass(mass).friction(friction).restitution(restitution)
        made.append(world.add_body(builder.can_sleep(False), [collider]))
    if floor:
        plane = rapier.Collider.halfspace((0.0, 0.0, 1.0))
        world.add_collider(plane.friction(friction).restitution(restitution))

    def read(i):
        body = world.rigid_bodies.get(made[i])
        x, v = body.translation, body.linvel
        return (x.x, x.y, x.z), (v.x, v.y, v.z)

    return world.step, read


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

"""ODE through panda3d's own interface to it: ``quickStep`` after ``autoCollide``.

Its contacts take the friction and the restitution of a surface table, so these act as they are written. The
speed below which nothing bounces has no default in ODE; it is 0 here.
"""

import measures
from panda3d import ode
from panda3d.core import Quat, Vec4

HARD = {"contact_cfm": 0.0}
WELL_SET = {"bounce": HARD, "small-drop": HARD, "clash": HARD, "mass-ratio": {"iterations": 100}}
EXTRA = {
    "1000 iterations": ("mass-ratio", {"iterations": 1000}),
    "solved exactly": ("mass-ratio", {"exact": True}),
}


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings``: iterations, contact_cfm, exact."""
    # quickStep shuffles its constraints with one generator for the whole process.
    ode.OdeUtil.randSetSeed(0)
    world, space, contacts = ode.OdeWorld(), ode.OdeHashSpace(), ode.OdeJointGroup()
    world.setGravity(*gravity)
    if "iterations" in settings:
        world.setQuickStepNumIterations(settings["iterations"])
    space.setAutoCollideWorld(world)
    space.setAutoCollideJointGroup(contacts)
    world.initSurfaceTable(1)
    cfm = settings.get("contact_cfm", world.getCfm())
    world.setSurfaceEntry(0, 0, friction, restitution, 0.0, world.getErp(), cfm, 0.0, 0.0)
    made, geoms = [], []
    for kind, size, mass, place, velocity in bodies:
        body, inertia, edge = ode.OdeBody(world), ode.OdeMass(), 2 * size
        if kind == "ball":
            inertia.setSphereTotal(mass, size)
            geom = ode.OdeSphereGeom(space, size)
        else:
            inertia.setBoxTotal(mass, edge, edge, edge)
            geom = ode.OdeBoxGeom(space, edge, edge, edge)
        body.setMass(inertia)
        body.setPosition(*place)
        body.setQuaternion(Quat.identQuat())
        body.setLinearVel(*velocity)
        geom.setBody(body)
        made.append(body)
        geoms.append(geom)
    if floor:
        geoms.append(ode.OdePlaneGeom(space, Vec4(0, 0, 1, 0)))
    advance = world.step if settings.get("exact") else world.quickStep

    def step(_alive=geoms):
        space.autoCollide()
        advance(measures.STEP)
        contacts.empty()

    return step, lambda i: (tuple(made[i].getPosition()), tuple(made[i].getLinearVel()))


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

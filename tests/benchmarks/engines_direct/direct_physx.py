"""PhysX 5 on the processor through sapien. Two materials' coefficients are averaged."""

import warnings

import measures
import numpy as np

with warnings.catch_warnings():
    # It looks for Vulkan, which draws; nothing is drawn here.
    warnings.simplefilter("ignore")
    import sapien
    from sapien import physx

LIVELY = {"bounce_threshold": 0.01}
WELL_SET = {"small-drop": LIVELY, "clash": LIVELY, "mass-ratio": {"solver_position_iterations": 100}}
EXTRA = {
    "255 iterations": ("mass-ratio", {"solver_position_iterations": 255}),
    "the older solver (PGS)": ("bounce", {"enable_tgs": False}),
}
_HALF = 0.7071067811865476


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings``: attributes of the scene's configuration and of a body."""
    config = physx.PhysxSceneConfig()
    config.gravity = np.array(gravity, dtype=np.float32)
    for name in ("bounce_threshold", "enable_tgs"):
        if name in settings:
            setattr(config, name, settings[name])
    physx.set_scene_config(config)
    system = physx.PhysxCpuSystem()
    system.timestep = measures.STEP
    scene = sapien.Scene([system])
    material = physx.PhysxMaterial(friction, friction, restitution)

    def enter(part, pose):
        entity = sapien.Entity()
        entity.add_component(part)
        entity.set_pose(pose)
        scene.add_entity(entity)

    made = []
    for kind, size, mass, place, velocity in bodies:
        half = np.full(3, size, dtype=np.float32)
        ball = kind == "ball"
        part = physx.PhysxRigidDynamicComponent()
        part.attach(
            physx.PhysxCollisionShapeSphere(size, material)
            if ball
            else physx.PhysxCollisionShapeBox(half, material)
        )
        part.mass = mass
        part.inertia = np.full(3, measures.inertia(kind, size, mass), dtype=np.float32)
        part.sleep_threshold = 0.0
        if "solver_position_iterations" in settings:
            part.solver_position_iterations = settings["solver_position_iterations"]
        enter(part, sapien.Pose(p=list(place)))
        part.set_linear_velocity(list(velocity))
        made.append(part)
    if floor:
        part = physx.PhysxRigidStaticComponent()
        part.attach(physx.PhysxCollisionShapePlane(material))
        # A plane's normal is its own x axis: turned up.
        enter(part, sapien.Pose(q=[_HALF, 0, -_HALF, 0]))

    def step(_alive=scene):
        system.step()

    def read(i):
        return tuple(map(float, made[i].entity_pose.p)), tuple(map(float, made[i].linear_velocity))

    return step, read


def swing(friction, damping):
    """By how many per cent of the rod a ball on a hinge strays from its true path in two seconds.

    It starts at the level of the hinge. ``None`` leaves what a joint or a link has by default.
    """
    physx.set_scene_config(physx.PhysxSceneConfig())
    system = physx.PhysxCpuSystem()
    system.timestep = measures.STEP
    scene = sapien.Scene([system])
    turned = [_HALF, 0, 0, _HALF]
    root = physx.PhysxArticulationLinkComponent(None)
    bob = physx.PhysxArticulationLinkComponent(root)
    inertia = measures.inertia("ball", 0.05, 1.0)
    bob.mass, bob.inertia = 1.0, np.full(3, inertia, dtype=np.float32)
    entities = []
    for link in (root, bob):
        entity = sapien.Entity()
        entity.add_component(link)
        entities.append(entity)
    joint = bob.joint
    joint.type = "revolute_unwrapped"
    joint.pose_in_parent = sapien.Pose(p=[0, 0, 0], q=turned)
    joint.pose_in_child = sapien.Pose(p=[-1, 0, 0], q=turned)
    joint.limit = np.array([[-np.inf, np.inf]], dtype=np.float32)
    if friction is not None:
        joint.friction = friction
    if damping is not None:
        bob.linear_damping = bob.angular_damping = damping
    root.joint.type = "fixed"
    for entity in entities:
        scene.add_entity(entity)
    root.articulation.set_qpos(np.zeros(1, dtype=np.float32))
    worst = 0.0
    for x, z in measures.true_swing(inertia, 480):
        system.step()
        place = bob.entity_pose.p
        worst = max(worst, float(np.hypot(place[0] - x, place[2] - z)))
    return [100.0 * worst]


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)
    for words, chosen in (
        ("a joint and a link as they come", (None, None)),
        ("no friction in the joint", (0.0, None)),
        ("no damping of the link", (None, 0.0)),
        ("neither", (0.0, 0.0)),
    ):
        measures.say("pendulum", words, swing(*chosen))

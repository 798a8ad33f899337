"""An SDF world run in DART, the engine of Gazebo Sim, built joint by joint; Gazebo itself is not here."""

import math
from xml.etree import ElementTree as ET

import dartpy as dart
import numpy as np


def ends(world_file, seconds):
    """Where each moving link is after a time, (x, y, z) in m."""
    described = ET.fromstring(world_file).find("world")
    world = dart.simulation.World()
    world.setTimeStep(float(described.findtext("physics/max_step_size")))
    world.setGravity(numbers(described.findtext("gravity")))
    awake = world.getDeactivationOptions()
    awake.mEnabled = False
    world.setDeactivationOptions(awake)
    links = {}
    for model in described.iterfind("model"):
        world.addSkeleton(standing(model) if model.findtext("static") == "true" else jointed(model, links))
    for _ in range(round(seconds / world.getTimeStep())):
        world.step()
    return {name: link.getWorldTransform().translation() for name, link in links.items()}


def standing(model):
    skeleton = dart.dynamics.Skeleton(model.get("name"))
    for link in model.iterfind("link"):
        joint, body = skeleton.createWeldJointAndBodyNodePair()
        joint.setTransformFromParentBodyNode(placed(link))
        shape(link, body)
    return skeleton


def jointed(model, links):
    """A tree of joints, each with its axis turned from the model's frame into its own, and its velocity."""
    skeleton = dart.dynamics.Skeleton(model.get("name"))
    described = {link.get("name"): link for link in model.iterfind("link")}
    plugin = model.find("plugin")
    moving = (
        {} if plugin is None else {n: float(plugin.findtext(n)) for n in plugin.findtext("joints").split()}
    )
    made = {}
    waiting = model.findall("joint")
    while waiting:
        joint = next(j for j in waiting if j.findtext("parent") in {"world", *made})
        waiting.remove(joint)
        parent, child = joint.findtext("parent"), described[joint.findtext("child")]
        kind = {"prismatic": "Prismatic", "revolute": "Revolute"}[joint.get("type")]
        make = getattr(skeleton, f"create{kind}JointAndBodyNodePair")
        held, body = make() if parent == "world" else make(made[parent])
        before = dart.math.Isometry3() if parent == "world" else placed(described[parent])
        at = placed(child).multiply(placed(joint))
        held.setTransformFromParentBodyNode(before.inverse().multiply(at))
        held.setTransformFromChildBodyNode(placed(joint))
        held.setAxis(at.rotation().T @ numbers(joint.findtext("axis/xyz")))
        held.setVelocity(0, moving.pop(joint.get("name"), 0.0))
        moments = [float(child.findtext(f"inertial/inertia/{axis}")) for axis in ("ixx", "iyy", "izz")]
        mass = float(child.findtext("inertial/mass"))
        body.setInertia(dart.dynamics.Inertia(mass, np.zeros(3), np.diag(moments)))
        shape(child, body)
        made[child.get("name")] = body
    assert not moving, "a velocity for a joint that is not there"
    links |= made
    return skeleton


def shape(link, body):
    for collision in link.iterfind("collision"):
        form = collision.find("geometry")[0]
        if form.tag == "sphere":
            made = dart.dynamics.SphereShape(float(form.findtext("radius")))
        elif form.tag == "box":
            made = dart.dynamics.BoxShape(numbers(form.findtext("size")))
        else:
            made = dart.dynamics.CapsuleShape(float(form.findtext("radius")), float(form.findtext("length")))
        node = body.createShapeNode(made)
        node.createCollisionAspect()
        node.createDynamicsAspect()
        node.setRelativeTransform(placed(collision))
        surface = node.getDynamicsAspect()
        surface.setFrictionCoeff(float(collision.findtext("surface/friction/ode/mu")))
        surface.setRestitutionCoeff(float(collision.findtext("surface/bounce/restitution_coefficient")))


def placed(element):
    """The pose of an element: turns about x, then y, then z, as SDF has it; only pitch and roll occur."""
    x, y, z, roll, pitch, yaw = numbers(element.findtext("pose") or "0 0 0 0 0 0")
    assert yaw == 0.0
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    found = dart.math.Isometry3()
    found.set_rotation(np.array([[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]]))
    found.set_translation([x, y, z])
    return found


def numbers(text):
    return np.array([float(word) for word in text.split()])

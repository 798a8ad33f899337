"""Exported worlds are what other engines read."""

from __future__ import annotations

import math
from xml.etree import ElementTree as ET

import pytest

from course.errors import UsageError
from course.sandbox.exports.mjcf import damping_ratio, mjcf
from course.sandbox.exports.sdf import VERSION, sdf
from course.sandbox.scene.loading import choose, scene_ids
from course.sandbox.scene.parts import layout
from course.sandbox.world.world import World

EXPORTED = sorted(set(scene_ids()) - {"galton-board", "robot-boxes"})


@pytest.mark.parametrize("name", EXPORTED)
def test_an_sdf_world_has_every_body_with_its_mass_place_and_surface(name: str) -> None:
    chosen = choose(name)
    root = ET.fromstring(sdf(chosen))
    assert root.tag == "sdf"
    assert root.get("version") == VERSION
    links = {link.get("name"): link for link in root.iterfind("world/model/link")}
    for part in layout(chosen.scene):
        link = links[part.name]
        if part.fixed:
            assert link.find("inertial") is None
        else:
            assert float(link.findtext("inertial/mass")) == part.mass
            assert float(link.findtext("inertial/inertia/iyy")) == part.moment
        bounce = link.findtext("collision/surface/bounce/restitution_coefficient")
        assert float(bounce) == part.restitution
        assert len(link.findall("collision/geometry/*")) == 1


def test_velocities_at_the_start_are_in_the_sdf_state() -> None:
    root = ET.fromstring(sdf(choose("head-on")))
    found = {m.get("name"): m.findtext("link/velocity") for m in root.iterfind("world/state/model")}
    assert found == {"left-puck": "2 0 0 0 0 0", "right-puck": "-1 0 0 0 0 0"}


def test_gravity_and_settings_reach_the_exports() -> None:
    chosen = choose("free-fall", {"gravity": 1.62, "step": 0.002})
    assert ET.fromstring(sdf(chosen)).findtext("world/gravity") == "0 0 -1.62"
    option = ET.fromstring(mjcf(chosen)).find("option")
    assert (option.get("gravity"), option.get("timestep")) == ("0 0 -1.62", "0.002")


@pytest.mark.parametrize("name", EXPORTED)
def test_mjcf_writes_out_the_product_of_each_pair(name: str) -> None:
    chosen = choose(name)
    root = ET.fromstring(mjcf(chosen))
    parts = {part.name: part for part in layout(chosen.scene)}
    pairs = root.findall("contact/pair")
    assert pairs or len(parts) < 2
    for pair in pairs:
        a, b = parts[pair.get("geom1")], parts[pair.get("geom2")]
        sliding = float(pair.get("friction").split()[0])
        assert sliding == pytest.approx(max(a.friction * b.friction, 1e-5))
        stiffness, damping = (-float(value) for value in pair.get("solref").split())
        zeta = damping / 2 / math.sqrt(stiffness)
        assert zeta == pytest.approx(damping_ratio(a.restitution * b.restitution), abs=1e-9)


def test_half_a_period_of_the_contact_spring_leaves_the_restitution() -> None:
    for e in (0.05, 0.5, 0.9, 1.0):
        zeta = damping_ratio(e)
        assert math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)) == pytest.approx(e)
    assert damping_ratio(0.0) == 1.0


@pytest.mark.parametrize("name", ["galton-board", "robot-boxes"])
@pytest.mark.parametrize("write", [sdf, mjcf])
def test_what_a_file_cannot_say_is_refused(name: str, write) -> None:
    with pytest.raises(UsageError, match="how a world begins"):
        write(choose(name))


@pytest.mark.parametrize("name", EXPORTED)
def test_mujoco_loads_every_export_and_steps_it(name: str) -> None:
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(mjcf(choose(name)).decode())
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(50):
        mujoco.mj_step(model, data)
    assert abs(data.qvel).max() < 1e3


@pytest.mark.parametrize(
    ("name", "settings", "within"),
    [("head-on", {}, 0.02), ("unequal-masses", {}, 0.02), ("head-on", {"restitution": 0.7}, 0.05)],
)
def test_mujoco_and_this_engine_agree_on_a_collision_of_two(name, settings, within: float) -> None:
    mujoco = pytest.importorskip("mujoco")
    chosen = choose(name, settings)
    model = mujoco.MjModel.from_xml_string(mjcf(chosen).decode())
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    while data.time < chosen.scene.duration:
        mujoco.mj_step(model, data)
    world = World(chosen.scene, chosen.settings)
    world.run_until(chosen.scene.duration)
    for part, row in zip(world.parts, world.state(), strict=True):
        theirs = data.qvel[model.jnt_dofadr[model.joint(f"{part.name}-x").id]]
        assert theirs == pytest.approx(row[3], abs=within * 3)

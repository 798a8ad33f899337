"""Contact models of one ball and one floor: rest, overlap, bounces, and friction from above."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.physics.contact.models import Constraint, Penalty, SoftConvex, drop, erp_cfm, slide_across

H, G = 0.01, 9.81


def lies(model, seconds=3.0):
    """How deep a ball lies after a while, m."""
    return -float(drop(model, 0.0, 0.0, H, round(seconds / H), G)[0][-1])


@given(st.floats(100.0, 1e4), st.floats(5.0, 50.0), st.floats(0.5, 2.0))
def test_a_penalty_floor_carries_a_ball_at_its_weight_over_the_stiffness(k, c, m):
    assert lies(Penalty(k, c, m), 20.0) == pytest.approx(m * G / k, rel=1e-3)


def test_a_penalty_floor_beyond_the_stability_limit_throws_the_ball():
    assert np.abs(drop(Penalty(5e4, 20.0), 0.0, 0.0, H, 300, G)[0]).max() > 1.0  # h omega = 2.2


@given(st.floats(100.0, 1e9), st.floats(0.0, 1e3), st.floats(0.5, 2.0))
def test_erp_and_cfm_are_a_spring_and_a_damper_integrated_implicitly(k, c, m):
    erp, cfm = erp_cfm(k, c, H)
    gap, v = -0.003, -0.02
    model_gap, model_v = Constraint(erp=erp, cfm=cfm, mass=m).step(gap, v, H, G)
    # (m + h c + h² k) v' = m v - h m g - h k gap
    implicit = (m * v - H * m * G - H * k * gap) / (m + H * c + H * H * k)
    assert model_v == pytest.approx(implicit, rel=1e-9, abs=1e-12)
    assert model_gap == pytest.approx(gap + H * implicit, abs=1e-12)


def test_a_constraint_holds_a_ball_exactly_and_never_pulls():
    gaps, speeds = drop(Constraint(), 0.0, 0.0, H, 100, G)
    assert not gaps.any()
    assert not speeds.any()
    leaving = drop(Constraint(), 0.0, 1.0, H, 5, G)[1]
    np.testing.assert_allclose(leaving, 1.0 - G * H * np.arange(6))


@pytest.mark.parametrize("timeconst", [0.02, 0.05])
def test_mujocos_floor_lets_every_ball_sink_as_its_impedance_says(timeconst):
    model = SoftConvex(timeconst)
    assert lies(model) == pytest.approx(model.resting_depth(G), rel=1e-6)
    flat = SoftConvex(timeconst, least=0.9, most=0.9)  # d k r = (1 - d) g, with k = 1 / (d timeconst²)
    assert flat.resting_depth(G) == pytest.approx(0.1 * G * timeconst**2)


@pytest.mark.parametrize("h", [0.01, 0.002])
def test_mujoco_itself_does_the_same_step_by_step(h):
    mujoco = pytest.importorskip("mujoco")
    world = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{h}"/><worldbody><geom type="plane" size="5 5 1"/>
        <body pos="0 0 0.52"><freejoint/><geom type="sphere" size="0.5" mass="3"/></body>
        </worldbody></mujoco>"""
    )
    data = mujoco.MjData(world)
    gaps = drop(SoftConvex(), 0.02, 0.0, h, 300, G)[0]
    for gap in gaps[1:]:
        mujoco.mj_step(world, data)
        assert data.qpos[2] - 0.5 == pytest.approx(gap, abs=1e-6)


def test_a_correction_in_the_velocity_makes_a_ball_hop_and_a_split_one_does_not():
    hops = [
        float(drop(Constraint(erp=0.8, split=split), -0.02, 0.0, H, 100, G)[0].max())
        for split in (False, True)
    ]
    assert hops[0] == pytest.approx(0.1186, abs=1e-4)
    assert hops[1] <= 0.0


def test_a_split_correction_takes_out_its_share_of_the_overlap_each_step():
    gaps, _ = drop(Constraint(erp=0.3, split=True), -0.02, 0.0, H, 5, G)
    np.testing.assert_allclose(gaps, -0.02 * 0.7 ** np.arange(6))


def test_below_the_threshold_nothing_bounces():
    for threshold, bounces in ((0.5, True), (1.0, False)):
        _, speeds = drop(Constraint(0.5, threshold), 0.04, 0.0, 0.001, 200, G)  # arrives at 0.89 m/s
        assert bool(np.any(speeds > 0.1)) is bounces


@given(st.floats(0.0, 0.5 * math.pi))
def test_the_cone_stops_a_block_equally_far_in_every_direction(angle):
    end = slide_across(angle, 2.0, 0.3, 1e-3, limit="cone")[-1]
    assert np.linalg.norm(end) == pytest.approx(4 / (2 * 0.3 * G) - 2.0 * 1e-3 / 2, abs=5e-6)
    assert math.atan2(end[1], end[0]) == pytest.approx(angle, abs=1e-9)


def test_the_outer_pyramid_is_the_cone_along_its_axes_and_another_floor_between_them():
    along, between, across = (
        np.linalg.norm(slide_across(angle, 2.0, 0.3, 1e-4, limit="outer")[-1])
        for angle in (0.0, math.radians(20), 0.25 * math.pi)
    )
    assert along == pytest.approx(0.6796, abs=2e-4)
    assert across == pytest.approx(along * math.sqrt(0.5), rel=1e-3)
    assert across < between < along


def test_the_inner_pyramid_is_mujocos():
    """Where MuJoCo 3.3 took a box with its default cone at 2 m/s and mu = 0.3; angles in degrees."""
    for start, far, bent in ((0, 0.679, 0.0), (20, 0.807, 32.7), (45, 0.960, 45.0)):
        end = slide_across(math.radians(start), 2.0, 0.3, 1e-3, limit="inner")[-1]
        assert np.linalg.norm(end) == pytest.approx(far, abs=1e-3)
        assert math.degrees(math.atan2(end[1], end[0])) == pytest.approx(bent, abs=0.05)


def test_a_limit_that_is_none_is_refused():
    with pytest.raises(ValueError, match="cone, outer, inner"):
        slide_across(0.0, 2.0, 0.3, 1e-3, limit="square")

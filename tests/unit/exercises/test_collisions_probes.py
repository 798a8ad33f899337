"""The references of ``collisions`` against other sources, and where its probes must not speak.

What known wrong programs are told is in ``solutions/collisions/record.json``, which the audit keeps.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.simulator import Simulator
from course.physics.state import RigidBodyState
from course.scoring import kit

ROOT = Path(__file__).parents[3]
bundles = kit.companion("collisions", "bundles")
probes, paths, tracks = bundles.probes, bundles.paths, bundles.tracks
formulas = kit.reference("collisions", "formulas")
motions = kit.reference("collisions", "motions")
draws = kit.reference("collisions", "draws")
report = kit.companion("collisions", "report")
SOURCE = (ROOT / "solutions" / "collisions" / "collisions.py").read_text()


@pytest.mark.parametrize("e", [1.0, 0.6, 0.0])
def test_the_head_on_path_is_that_of_the_course_s_own_simulator(e):
    scene = paths.HeadOn((1.0, 2.5), (-3.0, 2.0), (2.0, -1.0), 0.4, e)
    balls = [
        Body.sphere(m, scene.radius, RigidBodyState.of([x, 0, 0], [v, 0, 0]))
        for m, x, v in zip(scene.m, scene.x0, scene.v0, strict=True)
    ]
    run = Simulator(balls, h=0.01, gravity=0.0, ground=None, surface=Surface(restitution=e)).run(3.0)
    truth = motions.meeting(scene)
    assert run.position[:, :, 0] == pytest.approx(scene.at(run.t, truth.contact, truth.after)[0], abs=1e-9)


def test_each_hop_of_the_drop_keeps_e_squared_of_the_height_and_the_last_one_ends():
    times, speeds = map(np.array, motions.contacts(paths.Drop(1.0, 0.0, 0.1, 0.7), 10.0, 0.1))
    assert speeds[:-1] ** 2 / (2 * 9.81) == pytest.approx(0.9 * 0.49 ** np.arange(1, len(speeds)))
    assert np.diff(times) == pytest.approx(2 * speeds[:-1] / 9.81)
    assert speeds[-2] > 0.1
    assert speeds[-1] == 0.0


@pytest.mark.parametrize(
    ("path", "code"),
    [
        (lambda t, x, v: (x + 0.01, v), "INITIAL_STATE_WRONG"),
        (lambda t, x, v: (x.astype(np.float32), v.astype(np.float32)), "PRECISION_LOST"),
        # Slowed down once more, while they move apart.
        (
            lambda t, x, v: (
                x - np.maximum(t[:, None] - 1.5, 0) * v / 2,
                np.where(t[:, None] < 1.5, v, v / 2),
            ),
            "IMPULSE_ON_SEPARATING",
        ),
        (lambda t, x, v: (x, np.where(t[:, None] < 1.5, v, v / 2)), "VELOCITIES_APART"),
        # The first velocities stand in all rows.
        (lambda t, x, v: (x, np.broadcast_to(v[0], v.shape)), "VELOCITIES_APART"),
    ],
)
def test_head_on_paths_of_which_no_program_is_known_are_told(path, code):
    scene = paths.HeadOn((1.0, 2.0), (-1.0, 1.07), (1.0, -0.9), 0.5, 0.5)
    t, truth = 0.1 * np.arange(21), motions.meeting(scene)
    wrong = path(t, *scene.at(t, truth.contact, truth.after))
    assert tracks.of_head_on(scene, truth, t, *wrong, 0.1).code == code


@pytest.mark.parametrize(
    ("e", "path", "code"),
    [
        (0.7, lambda t, at, truth: at(t) * [[1], [-1]], "VELOCITIES_APART"),
        # A millisecond ahead: of a ball that loses nothing, a floor at another height shows in the same way.
        (1.0, lambda t, at, truth: at(np.where(t < truth.times[0], t, t + 1e-3)), None),
        # It slides along the floor, and gravity goes on: that is no speed at the end of a step.
        (1.0, lambda t, at, truth: (np.maximum(1 - 9.81 * t**2 / 2, 0.1), -9.81 * t), "GAINS_ENERGY"),
        # At rest at zero it looks like rows that were not written.
        (0.3, lambda t, at, truth: np.where(t < truth.may, at(t), 0.0), "RESTS_ELSEWHERE"),
    ],
)
def test_of_a_drop_no_more_is_said_than_it_shows(e, path, code):
    scene, h = paths.Drop(1.0, 0.0, 0.1, e), 0.01
    t, truth = h * np.arange(100), motions.bounces(scene, 1.0, h)
    wrong = path(t, lambda s: np.array(scene.at(s, truth.times, truth.speeds)), truth)
    found = tracks.of_drop(scene, truth, t, *wrong, h)
    assert (found and found.code) == code


@pytest.mark.parametrize("e", [0.0, 0.005])
def test_a_ball_that_bounces_once_a_step_is_told(e):
    """It rests by its speed before the contact; one that is back within the step goes into the floor."""
    scene, h = paths.Drop(0.6, -0.3, 0.1, e), 0.02
    once = LocalSubmission(SOURCE.replace("resting = up <= g * h", "resting = speed <= g * h"))
    path = once.call("simulate_drop", *scene.args(80 * h, h))
    assert tracks.of_drop(scene, motions.bounces(scene, 81 * h, h), *path, h).code == "ONE_BOUNCE_A_STEP"


def test_a_ball_that_falls_on_while_it_lies_on_the_floor_loses_points():
    """It had full marks where the velocity of a last hop is free: one impact a step, then free fall."""
    scene, t_end, h = draws.twice_in_a_step(np.random.default_rng(3))
    (truth,) = bundles.bounces([(scene, t_end, h)])
    t = h * np.arange(round(t_end / h) + 1)
    z, v = scene.at(t, truth.times, truth.speeds)
    bundles.expect_drop(scene, truth, (t, z, v), t_end, h, "wrong")
    with pytest.raises(kit.CheckFailed):
        bundles.expect_drop(scene, truth, (t, z, np.where(t == t[2], -0.1, v)), t_end, h, "wrong")


@pytest.mark.parametrize("e", [0.3, 0.7])
def test_between_the_two_readings_of_rest_only_their_two_paths_are_right(e):
    """A hop of another height had full marks there, and a later row was said to differ first."""
    scene, t_end, h = draws.settling(np.random.default_rng(8), e)
    (truth,) = bundles.bounces([(scene, t_end, h)])
    t = h * np.arange(round(t_end / h) + 1)
    for speeds in (truth.speeds, paths.hopping(scene, truth)):
        z, v = scene.at(t, truth.times, speeds)
        rests = t >= truth.must
        z, v = np.where(rests, scene.radius, z), np.where(rests, 0.0, v)
        bundles.expect_drop(scene, truth, (t, z, v), t_end, h, "wrong")
        between = (t > truth.may) & (t < truth.must)
        assert between.any()
        for other in ((z + 1e-6 * between, v), (z, v + 1e-6 * between)):
            with pytest.raises(kit.CheckFailed):
                bundles.expect_drop(scene, truth, (t, *other), t_end, h, "wrong")


@pytest.mark.parametrize("seed", range(5))
def test_a_ball_that_touches_slowly_has_one_path_and_the_first_row_off_it_is_told(seed):
    scene, t_end, h = draws.settling_at_once(np.random.default_rng(seed))
    (truth,) = bundles.bounces([(scene, t_end, h)])
    t = h * np.arange(round(t_end / h) + 1)
    bounces = scene.at(t, *motions.contacts(scene, t_end, 1e-9))
    with pytest.raises(kit.CheckFailed) as failed:
        bundles.expect_drop(scene, truth, (t, *bounces), t_end, h, "wrong")
    assert failed.value.finding.first_divergence.step == np.argmax(t > truth.may)


KEPT = ["sphere_kept", "plane_kept", "resolve_kept", "friction_kept", "moment_kept", "head_on_kept"]


@pytest.mark.parametrize("check", KEPT)
@pytest.mark.parametrize("seed", [None, 1, 2])
def test_what_a_call_may_not_change_would_be_changed_by_any_difference_or_sum(check, seed):
    (asked,) = bundles.asked(check, None if seed is None else np.random.default_rng(seed))
    args = asked[0].args(*asked[1:]) if check == "head_on_kept" else asked
    vectors = [arg for arg in args if isinstance(arg, np.ndarray)]
    assert len(vectors) > 1
    assert all(vector.all() for vector in vectors)
    assert all(np.all(a != b) for i, a in enumerate(vectors) for b in vectors[:i] if len(a) == len(b))


@pytest.mark.parametrize("spoil", [math.nan, math.inf, 1e308, -1e308])
def test_paths_that_blow_up_half_way_are_wrong_and_no_probe_stumbles_over_them(spoil):
    ball, pair = paths.Drop(1.0, 0.0, 0.1, 0.7), paths.HeadOn((1.0, 2.0), (-1.0, 0.6), (2.0, -1.0), 0.5, 0.5)
    bounces, meeting, t = motions.bounces(ball, 1.0, 0.01), motions.meeting(pair), 0.01 * np.arange(100)
    fall, way = ball.at(t, bounces.times, bounces.speeds), pair.at(t, meeting.contact, meeting.after)
    for expect, scene, truth, path in (
        (bundles.expect_drop, ball, bounces, fall),
        (bundles.expect_head_on, pair, meeting, way),
    ):
        blown = [np.concatenate([part[:50], np.full_like(part[50:], spoil)]) for part in path]
        with pytest.raises(kit.CheckFailed) as failed:
            expect(scene, truth, (t, *blown), 0.99, 0.01, "wrong")
        assert not failed.value.broke


def test_a_ball_that_settles_at_once_would_still_fly_by_a_rule_that_is_not_that_of_g_h():
    """By g times the rest of the step it would rest at its third contact or later."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        scene, t_end, h = draws.settling_at_once(rng)
        steps, truth = scene.fastest / (scene.g * h), motions.bounces(scene, t_end, h)
        assert truth.speeds == (0.0,)
        assert truth.must < 5 * scene.fastest / scene.g
        assert all(steps > math.ceil(contact * steps) - contact * steps for contact in (1, 3))


RNG, NAN = np.random.default_rng(2), np.full(3, np.nan)
MEETS = [draws.passing(RNG, 3, 0.3) for _ in range(4)]
MOMENTS = [(formulas.RIGHT["time_of_impact"](*call), call[-1] / 1000) for call in MEETS]
#: At instants of a search, and before the contacts: a search in steps finds them late.
EARLY = [None, *(part * math.floor(moment / part) for moment, part in MOMENTS[1:])]
PARTS, APART, SLIDES = draws.overlap(RNG, False), draws.spheres(RNG, 3, 0.8), draws.friction(RNG, 3, 0.6)
WALLS = [draws.wall(draws.friction(RNG, 3, 0.6), side) for side in (0, 1)]
ONE_SMOOTH = [formulas.RIGHT["resolve_with_friction"](*call) for call in ((*WALLS[0][:-1], 0.0), WALLS[1])]


@pytest.mark.parametrize(
    ("task", "calls", "values", "code"),
    [
        ("time_of_impact", MEETS, EARLY, "CONTACTS_MISSED"),
        ("time_of_impact", [PARTS], [PARTS[-1]], None),
        ("resolve_with_friction", WALLS, ONE_SMOOTH, None),
        # nan where bodies slide, and where centres do not coincide.
        ("resolve_with_friction", [SLIDES], [(NAN, NAN)], None),
        ("detect_sphere_sphere", [APART], [(True, NAN, 0.1)], "NORMAL_NOT_UNIT"),
    ],
)
def test_of_single_calls_no_more_is_said_than_they_show(task, calls, values, code):
    found = probes.of_calls(task, calls, values, [formulas.RIGHT[task](*call) for call in calls])
    assert (found and found.code) == code


@pytest.mark.parametrize("wrong", [False, True])
def test_the_report_predicts_pymunk_s_difference_and_describes_the_one_that_is_drawn(wrong):
    source = SOURCE.replace("return t, ", "return t, 0.25 + ") if wrong else SOURCE
    sections = report.report(LocalSubmission(source)).sections
    head_on, drop = (section.plot.description for section in sections[2:])
    assert ("at most 0.00 mm up to the contact" in head_on) is not wrong
    assert ("at most 250.00 mm up to the contact" in head_on) is wrong
    assert ("ms: -2" in drop) is wrong
    assert wrong or all(row[2] == row[3] for row in sections[2].rows)
    pair = sections[0]
    assert len(pair.rows) == len(pair.plot.panels) == 3
    assert wrong or all((row[1], row[4]) == (row[2], row[5]) for row in pair.rows)


def test_the_report_draws_the_program_that_is_still_to_be_mended():
    stub = (ROOT / "exercises" / "collisions" / "collisions.py").read_text()
    first, second, *_ = report.report(LocalSubmission(stub)).sections
    assert first.rows[0][1] == "5.000000 m"  # the left ball ends where the right one began
    assert "not written yet" in second.text

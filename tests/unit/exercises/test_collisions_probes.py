"""Which paths of ``collisions`` are right, and where its probes must not speak.

What known wrong programs are told is in ``solutions/collisions/record.json``, which the audit keeps.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

SOLUTION = Path(__file__).resolve().parents[3] / "solutions" / "collisions" / "collisions.py"
bundles = kit.companion("collisions", "bundles")
probes, paths, tracks = bundles.probes, bundles.paths, bundles.tracks
formulas = kit.reference("collisions", "formulas")
motions = kit.reference("collisions", "motions")
draws = kit.reference("collisions", "draws")


@pytest.mark.parametrize(
    ("e", "path", "code"),
    [
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
def test_a_ball_that_bounces_once_a_step(e):
    """It rests by its speed before the contact; one that is back within the step goes into the floor."""
    scene, h = paths.Drop(0.6, -0.3, 0.1, e), 0.02
    once = LocalSubmission(SOLUTION.read_text().replace("resting = up <= g * h", "resting = speed <= g * h"))
    path, truth = once.call("simulate_drop", *scene.args(80 * h, h)), motions.bounces(scene, 81 * h, h)
    assert tracks.of_drop(scene, truth, *path, h).code == "ONE_BOUNCE_A_STEP"


def test_a_meeting_that_is_rounded():
    scene = paths.HeadOn((1.0, 2.0), (-1.0, 1.07), (1.0, -0.9), 0.5, 0.5)
    t, truth = 0.1 * np.arange(21), motions.meeting(scene)
    x, v = scene.at(t, truth.contact, truth.after)
    single = x.astype(np.float32), v.astype(np.float32)
    assert tracks.of_head_on(scene, truth, t, *single, 0.1).code == "PRECISION_LOST"


def drop(drawn):
    """A drop: its scene, its right bounces, its times, and the check of a path."""
    scene, t_end, h = drawn
    (truth,) = bundles.bounces([drawn])
    t = h * np.arange(round(t_end / h) + 1)
    return scene, truth, t, lambda z, v: bundles.expect_drop(scene, truth, (t, z, v), t_end, h, "wrong")


def test_a_ball_that_falls_on_while_it_lies_on_the_floor_loses_points():
    """It had full marks where the velocity of a last hop is free: one impact a step, then free fall."""
    scene, truth, t, expect = drop(draws.twice_in_a_step(np.random.default_rng(3)))
    z, v = scene.at(t, truth.times, truth.speeds)
    expect(z, v)
    with pytest.raises(kit.CheckFailed):
        expect(z, np.where(t == t[2], -0.1, v))


@pytest.mark.parametrize("e", [0.3, 0.7])
def test_between_the_two_readings_of_rest_only_their_two_paths_are_right(e):
    """A hop of another height had full marks there, and a later row was said to differ first."""
    scene, truth, t, expect = drop(draws.settling(np.random.default_rng(8), e))
    rests, between = t >= truth.must, (t > truth.may) & (t < truth.must)
    assert between.any()
    for speeds in (truth.speeds, paths.hopping(scene, truth)):
        z, v = scene.at(t, truth.times, speeds)
        z, v = np.where(rests, scene.radius, z), np.where(rests, 0.0, v)
        expect(z, v)
        for other in ((z + 1e-6 * between, v), (z, v + 1e-6 * between)):
            with pytest.raises(kit.CheckFailed):
                expect(*other)


@pytest.mark.parametrize("spoil", [math.nan, math.inf, 1e308, -1e308])
def test_paths_that_blow_up_half_way_are_wrong_and_no_probe_stumbles_over_them(spoil):
    ball, pair = paths.Drop(1.0, 0.0, 0.1, 0.7), paths.HeadOn((1.0, 2.0), (-1.0, 0.6), (2.0, -1.0), 0.5, 0.5)
    bounces, meeting, t = motions.bounces(ball, 1.0, 0.01), motions.meeting(pair), 0.01 * np.arange(100)
    for expect, scene, truth, path in (
        (bundles.expect_drop, ball, bounces, ball.at(t, bounces.times, bounces.speeds)),
        (bundles.expect_head_on, pair, meeting, pair.at(t, meeting.contact, meeting.after)),
    ):
        blown = [np.concatenate([part[:50], np.full_like(part[50:], spoil)]) for part in path]
        with pytest.raises(kit.CheckFailed) as failed:
            expect(scene, truth, (t, *blown), 0.99, 0.01, "wrong")
        assert not failed.value.broke


RNG, NAN = np.random.default_rng(2), np.full(3, np.nan)
PARTS, SLIDES = draws.overlap(RNG, False), draws.friction(RNG, 3, 0.6)
WALLS = [draws.wall(draws.friction(RNG, 3, 0.6), side) for side in (0, 1)]
ONE_SMOOTH = [formulas.RIGHT["resolve_with_friction"](*call) for call in ((*WALLS[0][:-1], 0.0), WALLS[1])]


@pytest.mark.parametrize(
    ("task", "calls", "values"),
    [
        ("time_of_impact", [PARTS], [PARTS[-1]]),
        ("resolve_with_friction", WALLS, ONE_SMOOTH),
        ("resolve_with_friction", [SLIDES], [(NAN, NAN)]),  # where bodies slide, nan has another reason
    ],
)
def test_of_single_calls_no_more_is_said_than_they_show(task, calls, values):
    assert probes.of_calls(task, calls, values, [formulas.RIGHT[task](*call) for call in calls]) is None

"""Names that no wrong program on record has: each is still given, to what it is true of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

SOLUTIONS = Path(__file__).resolve().parents[3] / "solutions"
bundles = kit.companion("collisions", "bundles")
motions = kit.reference("collisions", "motions")
sensors, scenes = (kit.companion("digital-twin", name) for name in ("sensor_probes", "scenes"))
recordings = kit.companion("digital-twin", "sensor_bundles").recordings
bench, cart, judge, probes = (
    kit.companion("sim-to-real", name) for name in ("bench", "cart", "judge", "probes")
)


@pytest.mark.parametrize("e", [0.0, 0.005])
def test_a_ball_that_bounces_once_a_step(e):
    """It rests by its speed before the contact; one that is back within the step goes into the floor."""
    scene, h = bundles.paths.Drop(0.6, -0.3, 0.1, e), 0.02
    source = (SOLUTIONS / "collisions" / "collisions.py").read_text()
    once = LocalSubmission(source.replace("resting = up <= g * h", "resting = speed <= g * h"))
    path, truth = once.call("simulate_drop", *scene.args(80 * h, h)), motions.bounces(scene, 81 * h, h)
    assert bundles.tracks.of_drop(scene, truth, *path, h).code == "ONE_BOUNCE_A_STEP"


@pytest.mark.parametrize(
    ("path", "code"),
    [
        (lambda x, v: (x + 0.01, v), "INITIAL_STATE_WRONG"),
        (lambda x, v: (x.astype(np.float32), v.astype(np.float32)), "PRECISION_LOST"),
    ],
)
def test_a_meeting_that_begins_elsewhere_or_is_rounded(path, code):
    scene = bundles.paths.HeadOn((1.0, 2.0), (-1.0, 1.07), (1.0, -0.9), 0.5, 0.5)
    t, truth = 0.1 * np.arange(21), motions.meeting(scene)
    wrong = path(*scene.at(t, truth.contact, truth.after))
    assert bundles.tracks.of_head_on(scene, truth, t, *wrong, 0.1).code == code


@pytest.mark.parametrize(("seconds", "code"), [(0.6, None), (20.0, "BIAS0_TIME_TOO_LONG")])
def test_a_bias_that_is_the_mean_of_another_stretch(seconds, code):
    known = 0.01, 0.002, 0.006, -0.1
    cases = [(scenes.recording(np.random.default_rng(i), 8000, *known), *known) for i in range(4)]
    found = np.array([np.mean(still[: round(seconds / dt)]) for still, dt, *_ in cases])
    assert getattr(sensors.of_bias0(found, cases), "code", None) == code


def test_a_walk_that_is_too_large_and_one_that_is_a_square():
    right = LocalSubmission((SOLUTIONS / "digital-twin" / "digital_twin.py").read_text())

    def squared(still, dt):
        found = right.call("fit_noise", still, dt)
        return {**found, "bias_random_walk": found["bias_random_walk"] ** 2}

    cases = recordings(np.random.default_rng(2), 8, lambda: (0.01, 0.002, 0.003, 0.05))
    walks = np.array([case[3] for case in cases])
    assert sensors.of_walk(1.7 * walks, cases, right).code == "WALK_TOO_LARGE"
    squares = np.array([squared(*case[:2])["bias_random_walk"] for case in cases])
    submission = LocalSubmission("", replaced={"fit_noise": squared})
    assert sensors.of_walk(squares, cases, submission).code == "ROOT_FORGOTTEN"


@pytest.mark.parametrize(
    ("code", "tune"),
    [
        ("KD_IS_RATIO", lambda estimate, box: {"kp": 7.0 * estimate["m"][0], "kd": 0.48}),
        (
            "ENDS_READ",
            lambda estimate, box: {
                "kp": 7.0 * box["m"][1] * estimate["m"][2] + estimate["latency"][2],
                "kd": 2.4 * box["m"][1] * estimate["m"][2],
            },
        ),
    ],
)
def test_gains_that_say_how_they_came_about(code, tune):
    estimate, box = cart.with_intervals(cart.PUBLIC), cart.MATCHED
    gains = probes.gains_of(tune(estimate, box))
    asked = LocalSubmission("", replaced={"tune": tune})
    found = probes.of_gains(asked, estimate, box, gains, lambda *pair: cart.public_success(*pair)[0])
    assert found.code == code


def _fit(truth, u, y):
    """The README's fit at the right times: values, and the standard errors of a jackknife for ends."""
    values = dict(zip(("m", "b", "Fc"), bench.fits(u, y, truth["tau"], truth["latency"])[""], strict=True))
    known = {**truth, "lag": truth["tau"] + truth["latency"], **values}
    errors = bench.errors(u, y, truth["tau"], truth["latency"])[""]
    names = (*cart.NAMES, "lag")
    return {k: (known[k], known[k] - e, known[k] + e) for k, e in zip(names, errors, strict=True)}


def test_intervals_of_one_standard_error_and_times_that_are_exchanged():
    public, truths = judge.public_recordings()
    found = [_fit(truth, u, y) for (_, u, y), truth in zip(public, truths, strict=True)]
    assert probes.of_misses(found, truths, public).code == "INTERVAL_ONE_ERROR"
    swapped = [{**one, "tau": one["latency"], "latency": one["tau"]} for one in found]
    with pytest.raises(kit.CheckFailed) as caught:
        judge.expect_accurate(swapped, truths)
    assert caught.value.guess.code == "TIMES_EXCHANGED"

"""Programs of ``digital-twin`` whose mistake has the effect of another: they are not told that one."""

from __future__ import annotations

import importlib.util
import inspect
import math
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

ROOT = Path(__file__).resolve().parents[3]
SOLUTION = ROOT / "solutions" / "digital-twin"
spec = importlib.util.spec_from_file_location("digital_twin_again", SOLUTION / "digital_twin.py")
right = importlib.util.module_from_spec(spec)
spec.loader.exec_module(right)

actuator_bundles = kit.companion("digital-twin", "actuator_bundles")
actuators = kit.companion("digital-twin", "actuator_probes")
scanners = kit.companion("digital-twin", "lidar_probes")
sensors = kit.companion("digital-twin", "sensor_probes")
sensor_bundles = kit.companion("digital-twin", "sensor_bundles")
twins = kit.companion("digital-twin", "twin_probes")


class Fake:
    """The model solution with one function replaced."""

    def __init__(self, name, function):
        self._name, self._function = name, function

    def call(self, name, *args):
        with np.errstate(all="ignore"):
            return (self._function if name == self._name else getattr(right, name))(*args)

    def call_each(self, name, calls):
        return [self.call(name, *args) for args in calls]

    def call_inspect(self, name, *args):
        return kit.Inspected(self.call(name, *args), list(args), False)

    def fold(self, name, state, calls, *, keep=None):
        states = [state]
        for args in calls:
            states.append(self.call(name, states[-1], *args))
        return states if keep is None else [{k: s[k] for k in keep} for s in states[:-1]] + states[-1:]


def changed(task, *changes, source=None):
    """A right function with each (old, new) of its source exchanged."""
    source = inspect.getsource(getattr(right, task)) if source is None else source
    for old, new in changes:
        assert old in source, old
        source = source.replace(old, new)
    space = dict(vars(right))
    exec(source, space)
    return space[task]


def shares(*changes):
    """The same of the sync with constant shares."""
    return changed("sync", *changes, source=(SOLUTION / "accepted/constant_shares.py").read_text("utf-8"))


def told(task, function):
    """The code that the probes of a task give a function."""
    probe = {
        "imu": sensors.of_imu,
        "lidar": scanners.of_lidar,
        "motor_step": actuators.of_motor,
        "backlash": actuators.of_backlash,
        "delay_line": actuators.of_delay,
        "diff_drive_step": actuators.of_drive,
        "sync": twins.of_sync,
        "command": twins.of_command,
    }[task]
    return getattr(probe(Fake(task, function)), "code", None)


STEPS, NOISE = "bias_random_walk * math.sqrt(dt)", "noise_density / math.sqrt(dt)"
DRAWN = "rng.standard_normal(n - 1)"
IMU = [
    # The two strengths exchanged, or one of them used for both: the bias holds no white noise, and it moves.
    (
        "STRENGTHS_MIXED",
        [(STEPS, "noise_density * math.sqrt(dt)"), (NOISE, "bias_random_walk / math.sqrt(dt)")],
    ),
    ("STRENGTHS_MIXED", [(NOISE, "bias_random_walk / math.sqrt(dt)")]),
    ("STRENGTHS_MIXED", [(STEPS, "noise_density * math.sqrt(dt)")]),
    ("STRENGTHS_MIXED", [(STEPS, "(noise_density + bias_random_walk) * math.sqrt(dt)")]),
    # A number that is not random is no number that all samples share.
    ("WHITE_NOISE_MISSING", [(NOISE + " * rng.standard_normal(n)", NOISE)]),
    ("WHITE_NOISE_SHARED", [("rng.standard_normal(n)", "rng.standard_normal()")]),
    ("BIAS_OUT_OF_STEP", [("(n), bias", "(n), np.full(n, bias0)")]),
    ("BIAS_DRIFTS", [(DRAWN, "np.full(n - 1, rng.standard_normal())")]),
    ("BIAS_STEPS_RELATED", [("np.cumsum(steps)", "np.cumsum(np.cumsum(steps))")]),
    ("BIAS_STEPS_RELATED", [(DRAWN, "np.convolve(rng.standard_normal(n), (0.5, 0.5), 'valid')")]),
    ("TRUE_RATE_MISSING", [("true + bias", "bias")]),
    (None, [("true + bias", "dt * true + bias")]),
    # Single precision is neither a step too many nor another bias.
    (None, [("bias0 + np", "np.float32(bias0) + np")]),
    (None, [("return true + bias", "return np.float32(true + bias)")]),
    (None, [("bias0 + np", "2 * bias0 + np")]),
]


@pytest.mark.parametrize(("code", "changes"), IMU, ids=[f"{i}-{code}" for i, (code, _) in enumerate(IMU)])
def test_a_gyroscope_is_told_no_other_mistake_of_the_same_effect(code, changes):
    assert told("imu", changed("imu", *changes)) == code


def test_a_bias_is_called_carried_over_only_if_it_starts_where_the_last_one_ended():
    kept = {"last": 0.0}

    def carrying(true, dt, density, walk, bias0, rng):
        measured, bias = right.imu(true, dt, density, walk, kept["last"], rng)
        kept["last"] = bias[-1]
        return measured, bias

    def fixed(true, dt, density, walk, bias0, rng):
        return right.imu(true, dt, density, walk, 0.7, rng)

    assert told("imu", carrying) == "BIAS_CARRIED_OVER"
    assert told("imu", fixed) is None


FITS = LocalSubmission("", replaced={"fit_noise": right.fit_noise})


def test_densities_that_err_both_ways_and_densities_that_are_too_large_are_not_taken_for_each_other():
    cases = sensor_bundles.recordings(np.random.default_rng(2), 8, lambda: (0.01, 0.002, 0.003, 0.05))
    density, walk = np.full(8, 0.002), np.full(8, 0.003)

    def code(found, beside=walk):
        return sensors.of_density(found, cases, beside).code

    assert code(1.5 * density) != "FIT_SWAPPED"  # though that is the walk's number
    assert code(walk, density) == "FIT_SWAPPED"
    assert code(density * np.tile([0.8, 1.2], 4)) == "DENSITY_SCATTERS"
    small = walk * np.array([0.6, 0.5, 0.01, 0.02, 0.6, 0.05, 0.3, 0.01])
    assert sensors.of_walk(small, cases, FITS).code == "WALK_TOO_SMALL"  # for all of them


def test_a_scanner_that_ignores_one_coordinate_is_not_told_that_it_never_moves():
    def sideways(pose, *rest):
        return right.lidar((0.0, pose[1], pose[2]), *rest)

    assert told("lidar", sideways) is None


ACTUATORS = [
    ("DEADBAND_WIDTH", "motor_step", [("abs(u) <= deadband", "abs(u) <= 0.8 * deadband")]),
    ("DEADBAND_WIDTH", "motor_step", [("abs(u) <= deadband", "abs(u) <= 1.2 * deadband")]),
    (None, "motor_step", []),
    ("GAP_SCALED", "backlash", [("gap / 2", "gap / math.sqrt(2)")]),
    ("GAP_SCALED", "backlash", [("gap / 2", "0.6 * gap")]),
    ("BACKLASH_RATE_DEPENDENT", "backlash", [("return y, y", "y = 0.5 * (y + state); return y, y")]),
    (None, "delay_line", [("np.interp(t - latency, t, x, left=0.0)", "np.where(t >= latency, x, 0.0)")]),
]


@pytest.mark.parametrize(("code", "task", "changes"), ACTUATORS)
def test_an_actuator_is_told_no_other_mistake_of_the_same_effect(code, task, changes):
    assert told(task, changed(task, *changes)) == code


REST = '"t": t_measured'
SYNC = [
    (
        "TIME_NOT_THE_LATEST",
        [(REST, '"t": twin["t"] + 0.3 * dt')],
    ),  # it lags behind, and does not stand still
    ("TIME_NOT_ADVANCED", [(REST, '"t": twin["t"]')]),
    ("SMALL_SURPRISES_IGNORED", [("z - x", "(z - x) * (abs(z - x) > 3 * twin['sigma'])")]),
    ("NO_CORRECTION", [("x + 0.3 * surprise", "x")]),
    ("PREDICTS_TOO_LITTLE", [("dt / n * v", "dt / n * v / 2")]),
    ("STEP_FIXED", [("n = max", "dt = min(dt, 0.1); n = max")]),
    ("FRICTION_LEARNS_BACKWARDS", [("b - 0.15", "b + 0.15")]),
    ("LEARNS_FORWARDS_ONLY", [("* np.sign(v)", "")]),
    ("SHARE_TOO_LARGE", [("x + 0.3", "x + 0.7")]),
    ("SHARE_OVER_ONE", [("x + 0.3", "x + 1.5")]),
]


@pytest.mark.parametrize(("code", "changes"), SYNC, ids=[f"{i}-{code}" for i, (code, _) in enumerate(SYNC)])
def test_a_twin_is_told_no_other_mistake_of_the_same_effect(code, changes):
    assert told("sync", shares(*changes)) == code


def test_a_history_that_only_late_measurements_read_is_read():
    slow = shares(("b - 0.15", "b - 0.02"))

    def with_history(twin, z, t):
        past = [place for when, place in twin["memory"].get("past", []) if when <= t]
        if t < twin["t"]:
            moved = 0.1 * (z - past[-1]) if past else 0.0
            return {**twin, "position": twin["position"] + moved}
        found = slow(twin, z, t)
        past = [*twin["memory"].get("past", []), (t, found["position"])][-10:]
        return {**found, "memory": {"past": past}}

    assert told("sync", with_history) == "FRICTION_LEARNS_SLOWLY"


def failed(check, *args, **kwargs):
    """The finding of a check that fails, and the code of what is said of it."""
    with pytest.raises(kit.CheckFailed) as caught:
        check(*args, **kwargs)
    return caught.value.finding, getattr(caught.value.guess, "code", None)


TURNLESS = ("heading + np.asarray(angles", "np.asarray(angles")


def test_beams_that_do_not_turn_are_no_reason_at_a_heading_of_0():
    """It was said beside a heading of 0, of a program whose noise was wrong as well."""
    both = changed("lidar", TURNLESS, ("sigma * rng", "3 * sigma * rng"))
    assert told("lidar", both) == "HEADING_IGNORED"
    finding, code = failed(
        sensor_bundles.expect_scan_noise, Fake("lidar", both), 7.0, 0.05, np.random.default_rng(9)
    )
    assert code == "SECOND_MISTAKE"
    assert "std sigma" in finding.message


def test_a_dead_band_is_no_reason_for_a_motor_beyond_its_limit():
    def motor(w, u, dt, tau, u_max, deadband):
        u = 0.0 if abs(u) <= 0.7 * deadband else min(max(u, -u_max), u_max)
        return min(max(w, -u_max), u_max) + (1 - math.exp(-dt / tau)) * (u - min(max(w, -u_max), u_max))

    assert told("motor_step", motor) == "DEADBAND_WIDTH"
    calls = [(u, 0.1, 0.2, 10.0, 0.5) for u in (8.0, 0.45)]
    finding, code = failed(actuator_bundles.expect_motor, Fake("motor_step", motor), 25.0, calls, "Wrong.")
    assert code == "SECOND_MISTAKE"
    assert "The speed is limited" in finding.message


def test_learning_forwards_only_is_no_reason_while_a_cart_rolls_forwards():
    one_way = shares((" * np.sign(v)", ""))
    assert told("sync", one_way) == "LEARNS_FORWARDS_ONLY"
    assert twins.of_sync(Fake("sync", one_way), {"LEARNS_FORWARDS_ONLY"}).code == "SECOND_MISTAKE"


def test_two_mistakes_of_a_twin_are_both_told():
    both = shares((" * np.sign(v)", ""), ('twin["drive"] - b * v', "-b * v"))
    said = twins.of_sync(Fake("sync", both))
    assert said.code == "DRIVE_NOT_USED"
    assert said.looks_like.count("First:") == said.looks_like.count("Second:") == 1
    assert "moves backwards" in said.looks_like


@pytest.mark.parametrize(
    ("share", "code"), [("0.15", None), ("0.5", None), ("3.0", "FRICTION_SHARE_TOO_LARGE")]
)
def test_a_friction_that_takes_more_than_a_surprise_is_told_so(share, code):
    assert told("sync", shares(("- 0.15", f"- {share}"))) == code


def test_counts_of_angles_in_single_precision_are_told_so():
    theta = sensor_bundles.angles_beside_counts(np.linspace(-51000, 51000, 20), 64)

    def counts(theta, per_turn):
        return np.floor(np.float32(theta) * per_turn / (2 * math.pi)).astype(np.int64)

    said = sensors.of_encoder(Fake("encoder", counts), counts(theta, 64), theta, 64)
    assert said.code == "COUNTS_SINGLE_PRECISION"


def test_noise_that_is_nan_is_not_asked_about_its_root():
    def divided(true, dt, density, walk, bias0, rng):
        measured, bias = right.imu(true, dt, density, walk, bias0, rng)
        return measured + np.float64(walk) / np.float64(walk), bias

    calls = [(np.zeros(50), 0.01, 0.002, 0.0, 0.1, np.random.default_rng(1))]
    finding, code = failed(sensor_bundles.expect_white, Fake("imu", divided), calls, 0.06, "six")
    assert code == "NOT_A_NUMBER"
    assert "0/0" in finding.help

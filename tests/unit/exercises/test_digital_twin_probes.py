"""The diagnosis of ``digital-twin``: what a mutant shows, and the mistakes that no mutant makes."""

from __future__ import annotations

import importlib.util
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from course.grading import kit

ROOT = Path(__file__).resolve().parents[3]
SOLUTION = ROOT / "solutions" / "digital-twin"
spec = importlib.util.spec_from_file_location("digital_twin_solution", SOLUTION / "digital_twin.py")
right = importlib.util.module_from_spec(spec)
spec.loader.exec_module(right)

words = kit.companion("digital-twin", "diagnosis").WORDS
sensors = kit.companion("digital-twin", "sensor_probes")
actuators = kit.companion("digital-twin", "actuator_probes")
twins = kit.companion("digital-twin", "twin_probes")
actuator_bundles = kit.companion("digital-twin", "actuator_bundles")
sensor_bundles = kit.companion("digital-twin", "sensor_bundles")
twin_bundles = kit.companion("digital-twin", "twin_bundles")
scenes = kit.companion("digital-twin", "scenes")


class Fake:
    """The model solution with one function replaced."""

    def __init__(self, name="", function=None):
        self._name, self._function = name, function

    def call(self, name, *args):
        with np.errstate(all="ignore"):
            return (self._function if name == self._name else getattr(right, name))(*args)

    def call_each(self, name, calls):
        return [self.call(name, *args) for args in calls]

    def call_inspect(self, name, *args):
        return kit.Inspected(self.call(name, *args), list(args), False)

    def fold(self, name, state, calls, *, carry=None, keep=None):
        states = [state]
        for args in calls:
            states.append(self.call(name, states[-1], *args))
        return states if keep is None else [{k: s[k] for k in keep} for s in states[:-1]] + states[-1:]


def imu(white=1.0, step=1.0, power=-0.5, step_power=0.5, add=1.0, seed=None):
    """An imu with its factors, powers of dt and sign as given."""

    def wrong(true, dt, density, walk, bias0, rng):
        rng = rng if seed is None else np.random.default_rng(seed)
        n = len(true)
        steps = step * walk * dt**step_power * rng.standard_normal(n - 1)
        bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
        return true + add * bias + white * density * dt**power * rng.standard_normal(n), bias

    return wrong


def accumulating(true, dt, density, walk, bias0, rng):
    measured, bias = right.imu(true, dt, density, walk, bias0, rng)
    return true + bias + np.cumsum(measured - true - bias), bias


def out_of_step(true, dt, density, walk, bias0, rng):
    measured, bias = right.imu(true, dt, density, walk, bias0, rng)
    return measured, np.append(bias[0], bias[:-1])


IMU = [
    ("WHITE_NOISE_MISSING", imu(white=0.0)),
    ("WHITE_NOISE_OVER_DT", imu(power=-1.0)),
    ("WHITE_NOISE_FACTOR", imu(white=1.41)),
    ("WHITE_NOISE_ACCUMULATES", accumulating),
    ("BIAS_CONSTANT", imu(step=0.0)),
    ("BIAS_NOT_SCALED_BY_SQRT_DT", imu(step_power=0.0)),
    ("BIAS_OVER_SQRT_DT", imu(step_power=-0.5)),
    ("BIAS_FACTOR", imu(step=0.7)),
    ("BIAS_NOT_ADDED", imu(add=0.0)),
    ("BIAS_SUBTRACTED", imu(add=-1.0)),
    ("BIAS_OUT_OF_STEP", out_of_step),
    ("GENERATOR_IGNORED", imu(seed=1)),
    ("RETURNS_SWAPPED", lambda *args: right.imu(*args)[::-1]),
]


@pytest.mark.parametrize(("code", "wrong"), IMU, ids=[code for code, _ in IMU])
def test_a_gyroscope_that_errs_is_told_its_mistake(code, wrong):
    assert sensors.of_imu(Fake("imu", wrong)).code == code


def moved(pose, segments, angles, r_max, sigma, rng):
    return right.lidar((0.0, 0.0, pose[2]), segments, angles, r_max, sigma, rng)


def parallel(pose, segments, angles, r_max, sigma, rng):
    ranges = right.lidar(pose, segments, angles, r_max, sigma, rng)
    across = [w for w in np.asarray(segments) if w[0][1] == w[1][1]]  # walls along x stop beams along x
    return np.where((np.abs(angles) < 1e-9) & bool(across), 1.0, ranges)


LIDAR = [
    ("POSITION_IGNORED", moved),
    ("PARALLEL_WALLS", parallel),
    ("BEYOND_RANGE", lambda p, s, a, r, sig, rng: right.lidar(p, s, a, r + 2 * (len(s) == 1), sig, rng)),
    ("NO_HIT_NOT_MAX", lambda *args: np.where(right.lidar(*args) == args[3], np.inf, right.lidar(*args))),
    ("NO_HIT_NOT_MAX", lambda *args: np.where(right.lidar(*args) == args[3], 0.0, right.lidar(*args))),
    ("LIDAR_NOISE_MISSING", lambda p, s, a, r, _sigma, rng: right.lidar(p, s, a, r, 0.0, rng)),
    ("LIDAR_SIGMA_WRONG", lambda p, s, a, r, sigma, rng: right.lidar(p, s, a, r, sigma**2, rng)),
]


@pytest.mark.parametrize(("code", "wrong"), LIDAR[1:], ids=[f"{i}-{c}" for i, (c, _) in enumerate(LIDAR[1:])])
def test_a_scanner_that_errs_is_told_its_mistake(code, wrong):
    if code == "BEYOND_RANGE":  # without a hit it still says r_max
        reach = wrong
        wrong = lambda *args: np.where(reach(*args) > 6.5, args[3], reach(*args))  # noqa: E731
    assert sensors.of_lidar(Fake("lidar", wrong)).code == code


def beams(direction):
    """The right lidar, looking along ``direction(angles, heading)``."""

    def wrong(pose, segments, angles, *rest):
        return right.lidar((*pose[:2], 0.0), segments, direction(np.asarray(angles), pose[2]), *rest)

    return wrong


def both_ways(pose, segments, angles, r_max, sigma, rng):
    ahead = right.lidar(pose, segments, np.asarray(angles), r_max, sigma, rng)
    return np.minimum(ahead, right.lidar(pose, segments, np.asarray(angles) + math.pi, r_max, sigma, rng))


DIRECTIONS = [
    ("HEADING_IGNORED", beams(lambda a, h: a)),
    ("HEADING_SUBTRACTED", beams(lambda a, h: a - h)),
    ("BEAM_IN_DEGREES", beams(lambda a, h: a + math.degrees(h))),
    ("BEAM_IN_DEGREES", beams(lambda a, h: np.radians(a + h))),
    ("BEAM_SIN_COS_SWAPPED", beams(lambda a, h: math.pi / 2 - a - h)),
    ("WALL_VECTOR_REVERSED", beams(lambda a, h: a + h + math.pi)),
    ("WALLS_BEHIND_SEEN", both_ways),
    ("HEADING_IGNORED", lambda pose, *rest: both_ways((*pose[:2], 0.0), *rest)),
    (None, beams(lambda a, h: a + 2 * h)),
    (None, beams(lambda a, h: 0.5 * (a + h))),
    (None, beams(lambda a, h: -a - h)),
]


@pytest.mark.parametrize(
    ("code", "wrong"), DIRECTIONS, ids=[f"{i}-{c}" for i, (c, _) in enumerate(DIRECTIONS)]
)
def test_beams_that_go_astray_are_told_where_to_only_if_it_is_known(code, wrong):
    assert getattr(sensors.of_lidar(Fake("lidar", wrong)), "code", None) == code


def test_no_two_ways_to_go_astray_read_the_same_in_the_crooked_room():
    found = [readings for _, readings in sensors._lidar_slips()]
    found.append(sensors._seen(sensors._FAN + sensors._HEADING))
    for i, a in enumerate(found):
        assert np.sum(a < sensors._REACH) >= 2
        assert all(np.max(np.abs(a - b)) > 1e-3 for b in found[:i])


def test_a_scanner_that_never_moves_is_told_so():
    assert sensors.of_lidar(Fake("lidar", moved)).code == "POSITION_IGNORED"


def test_the_room_of_the_checks_reads_as_the_model_solution_sees_it():
    rng, angles = np.random.default_rng(3), np.linspace(-3.1, 3.1, 90)
    for _ in range(20):
        pose = rng.uniform((0.3, 0.3, -3.0), (5.7, 3.7, 3.0))
        ranges = right.lidar(pose, scenes.ROOM, angles, 4.0, 0.0, rng)
        np.testing.assert_allclose(ranges, scenes.room_ranges(pose, angles, 4.0), atol=1e-9)


ENCODER = [
    ("ROUNDS_UP", lambda exact, theta, n: np.ceil(exact)),
    ("NOT_QUANTISED", lambda exact, theta, n: exact),
    ("RADIANS_AS_TURNS", lambda exact, theta, n: np.floor(theta * n)),
    ("DEGREES_FOR_RADIANS", lambda exact, theta, n: np.rint(theta * n / 360)),
    ("RETURNS_ANGLE", lambda exact, theta, n: np.floor(exact) * 2 * math.pi / n),
]


@pytest.mark.parametrize(("code", "wrong"), ENCODER, ids=[code for code, _ in ENCODER])
def test_an_encoder_that_errs_is_told_its_mistake(code, wrong):
    theta, n = np.linspace(-9.0, 9.0, 401) + 0.001, 64
    assert sensors.of_encoder(wrong(theta * n / (2 * math.pi), theta, n), theta, n).code == code


def test_a_density_without_its_root_of_two_is_told_so():
    still = scenes.recording(np.random.default_rng(1), 8000, 0.01, 0.002, 0.001, 0.0)
    found = np.array([np.std(np.diff(still)) * math.sqrt(0.01)])
    assert sensors.of_density(found, [(still, 0.01, 0.002)]).code == "DENSITY_FROM_DIFFERENCES"


def test_walks_and_biases_are_told_what_is_known_of_them_and_no_more():
    rng = np.random.default_rng(2)
    cases = sensor_bundles.recordings(rng, 8, lambda: (0.01, 0.002, 0.003, 0.05))
    walks = np.array([case[3] for case in cases])
    biases = np.array([case[4] for case in cases])
    assert min(biases) < 0 < max(biases)
    for code, factor in (("WALK_WITHOUT_THREE", 3**-0.5), ("WALK_TOO_SMALL", 0.2), ("WALK_TOO_LARGE", 1.7)):
        assert sensors.of_walk(factor * walks, cases).code == code
    neighbours = np.array([np.std(np.diff(case[0])) / 0.1 for case in cases])
    assert sensors.of_walk(neighbours, cases).code == "NOISE_COUNTED_AS_DRIFT"
    assert sensors.of_bias0(np.abs(biases), cases).code == "BIAS0_WITHOUT_SIGN"
    assert sensors.of_bias0(biases + 1.0, cases) is None


DRIVE = [
    ("EULER_TURNS_FIRST", actuators._arc(at=1.0, chord=False)),
    ("TRACK_HALVED", actuators._arc(track=actuators._TRACK / 2)),
    ("TRACK_DOUBLED", actuators._arc(track=actuators._TRACK * 2)),
    ("SPEEDS_ADDED", actuators._arc(reach=2.0)),
    ("SPEED_SUM_TURNS", actuators._arc(turn=lambda _: (0.31 + 0.83) / 0.47 * 1.3)),
]


def drive(change):
    """The right step with the turn, the chord's factor and the axes that ``change(turn, pose)`` gives."""

    def wrong(pose, v_left, v_right, track, dt):
        turn, factor, angle = change((v_right - v_left) / track * dt, pose[2])
        way = (v_left + v_right) / 2 * dt * factor
        return np.array([pose[0] + way * np.cos(angle), pose[1] + way * np.sin(angle), pose[2] + turn])

    return wrong


def chord(turn):
    return np.sinc(turn / (2 * np.pi))


STEPS = [
    ("SINC_WITHOUT_PI", drive(lambda turn, h: (turn, np.sinc(turn / 2), h + turn / 2))),
    ("TURN_IN_DEGREES", drive(lambda turn, h: (turn, chord(turn), np.radians(h + turn / 2)))),
    ("DRIVE_SIN_COS_SWAPPED", drive(lambda turn, h: (turn, chord(turn), np.pi / 2 - h - turn / 2))),
    ("DRIVE_SIN_COS_SWAPPED", drive(lambda turn, h: (turn, 1.0, np.pi / 2 - h))),
    (
        "SLOW_TURN_AS_STRAIGHT",
        drive(lambda turn, h: (turn, 1.0, h) if abs(turn) < 0.01 else (turn, chord(turn), h + turn / 2)),
    ),
    ("STRAIGHT_WRONG", drive(lambda turn, h: (turn, 2.0 if turn == 0 else chord(turn), h + turn / 2))),
    (None, drive(lambda turn, h: (turn, np.cos(turn), h + turn / 2))),
    (None, drive(lambda turn, h: (turn, chord(turn), h + turn / 3))),
    (None, drive(lambda turn, h: (turn, chord(turn) * (0.9 if 0 < turn < 0.5 else 1.0), h + turn / 2))),
]


@pytest.mark.parametrize(("code", "wrong"), STEPS, ids=[f"{i}-{c}" for i, (c, _) in enumerate(STEPS)])
def test_slow_turns_are_blamed_only_where_an_ordinary_one_is_right(code, wrong):
    assert getattr(actuators.of_drive(Fake("diff_drive_step", wrong)), "code", None) == code


def test_no_two_mistakes_of_a_step_end_at_the_same_pose():
    found = [("", actuators._arc()), *actuators._drive_slips()]
    for i, (code, pose) in enumerate(found):
        assert all(np.max(np.abs(pose - b)) > 1e-3 for other, b in found[:i] if other != code), code


@pytest.mark.parametrize(("code", "value"), DRIVE, ids=[code for code, _ in DRIVE])
def test_odometry_that_errs_is_told_its_mistake(code, value):
    assert actuators.of_drive(Fake("diff_drive_step", lambda *_args: value)).code == code


def test_odometry_that_divides_by_the_turn_rate_is_told_so():
    def wrong(pose, v_left, v_right, track, dt):
        rate = np.float64(v_right - v_left) / track
        radius, end = (v_left + v_right) / 2 / rate, pose[2] + rate * dt
        x = pose[0] + radius * (np.sin(end) - np.sin(pose[2]))
        return np.array([x, pose[1] - radius * (np.cos(end) - np.cos(pose[2])), end])

    assert actuators.of_drive(Fake("diff_drive_step", wrong)).code == "STRAIGHT_DIVIDES_BY_ZERO"


@pytest.mark.parametrize("task", ["motor", "play"])
def test_every_wrong_actuator_is_told_apart_from_the_right_one_and_from_every_other(task):
    name, probe, slips = {
        "motor": ("motor_step", actuators.of_motor, list(actuators._motor_slips())),
        "play": ("backlash", actuators.of_backlash, list(actuators._play_slips())),
    }[task]
    for code, values in slips:
        answers = iter(values)

        def wrong(*_args, answers=answers):
            value = next(answers)
            return value if name == "motor_step" else (value, value)

        assert probe(Fake(name, wrong)).code == code
    assert probe(Fake()) is None


DELAY = [
    ("DELAY_WRAPS", lambda x, dt, lag: np.roll(x, round(lag / dt))),
    ("DELAY_IN_SAMPLES", lambda x, dt, lag: right.delay_line(x, dt, lag * dt)),
    ("DELAY_RAMPS_IN", lambda x, dt, lag: right.delay_line(np.append(0.0, x), dt, lag)[1:]),
]


@pytest.mark.parametrize(("code", "wrong"), DELAY, ids=[code for code, _ in DELAY])
def test_a_delay_that_errs_is_told_its_mistake(code, wrong):
    x, dt, latency = np.array([2.0, 3.0, 1.0, 5.0, 4.0, 4.0, 0.0, 2.0]), 0.1, 0.225
    assert actuators.of_delay(wrong(x, dt, latency), x, dt, latency).code == code


def standing(twin, z, t):
    return {**twin, "t": max(t, twin["t"])}


def unmoved(twin, z, t):
    if t < twin["t"]:
        return dict(twin)
    return {**twin, "t": t, "position": twin["position"] + 0.3 * (z - twin["position"])}


def pushed(twin, z, t):
    if t < twin["t"]:
        return dict(twin)
    x = twin["position"] + twin["speed"] * (t - twin["t"])
    return {**twin, "t": t, "position": x - 0.3 * (z - x)}


def shares(old="", new=""):
    """The sync of constant shares, with ``new`` in place of ``old``."""
    source = (SOLUTION / "accepted" / "constant_shares.py").read_text(encoding="utf-8")
    assert old in source
    space = dict(vars(right))
    exec(source.replace(old, new), space)
    return space["sync"]


SYNC = [
    ("NO_CORRECTION", standing),
    ("NO_PREDICTION", unmoved),
    ("SURPRISE_INVERTED", pushed),
    ("TIME_NOT_ADVANCED", lambda twin, z, t: {**right.sync(twin, z, t), "t": twin["t"]}),
    ("SURPRISE_INVERTED", shares("z - x", "x - z")),
    ("FRICTION_SPEEDS_UP", shares("- b * v", "+ b * v")),
    ("FRICTION_LEARNS_BACKWARDS", shares("b - 0.15", "b + 0.15")),
    (None, shares("v + 0.3", "v - 0.3")),  # its memory is empty, and that is not what is wrong
    (None, shares('twin["drive"] -', '-twin["drive"] -')),
    (None, shares()),
]


@pytest.mark.parametrize(("code", "wrong"), SYNC, ids=[f"{i}-{code}" for i, (code, _) in enumerate(SYNC)])
def test_a_twin_that_errs_is_told_its_mistake(code, wrong):
    assert getattr(twins.of_sync(Fake("sync", wrong)), "code", None) == code


def test_a_right_twin_is_told_no_mistake():
    assert twins.of_sync(Fake()) is None
    assert twins.of_command(Fake()) is None
    assert sensors.of_imu(Fake()) is None
    assert sensors.of_lidar(Fake()) is None
    assert actuators.of_drive(Fake()) is None


COMMAND = [
    ("BRAKES", lambda twin, target: -twin["friction"] * target),
    ("ADDS_CURRENT_DRIVE", lambda twin, target: twin["drive"] + twin["friction"] * target),
    ("TARGET_IGNORED", lambda twin, target: twin["friction"]),
]


@pytest.mark.parametrize(("code", "wrong"), COMMAND, ids=[code for code, _ in COMMAND])
def test_a_command_that_errs_is_told_its_mistake(code, wrong):
    assert twins.of_command(Fake("command", wrong)).code == code


def test_every_mistake_that_has_words_is_made_by_a_mutant_or_a_test():
    mutants = tomllib.loads((SOLUTION / "mutants.toml").read_text())["mutant"]
    made = {mutant["diagnosis"] for mutant in mutants}
    for cases in (IMU, LIDAR, ENCODER, DRIVE, DELAY, SYNC, COMMAND):  # and the walks and biases above
        made |= {code for code, _ in cases}
    made |= {code for code, _ in actuators._motor_slips()} | {code for code, _ in actuators._play_slips()}
    made |= {"DENSITY_FROM_DIFFERENCES", "STRAIGHT_DIVIDES_BY_ZERO", "WALK_TOO_SMALL", "WALK_TOO_LARGE"}
    assert set(words) - made == set()


def test_the_cart_rolls_through_a_jump_of_its_friction_as_small_steps_do():
    cart = scenes.Cart(((0.0, 0.5), (1.0, 0.9)), v=1.2)
    cart.roll(0.4, 2.5)
    x, v, h = 0.0, 1.2, 1e-4
    for i in range(25000):
        a = 0.4 - (0.5 if i * h < 1.0 - 1e-9 else 0.9) * v
        x, v = x + h * v + h * h / 2 * a, v + h * a
    assert (cart.x, cart.v) == pytest.approx((x, v), abs=1e-4)


def test_late_measurements_arrive_out_of_order_and_the_truth_is_that_of_the_newest():
    cart = scenes.Cart(((0.0, 0.5),), v=1.0)
    run = scenes.measured(cart, 0.5, 0.1 * np.arange(1, 101), np.random.default_rng(2), late=0.3)
    times = np.array([t for _, t in run.calls])
    assert np.sum(np.diff(times) < 0) > 10
    np.testing.assert_allclose(run.truth[:, 0], np.maximum.accumulate(times))
    np.testing.assert_allclose(run.truth[:, 1], run.truth[:, 0])  # at 1 m/s throughout
    np.testing.assert_array_equal(run.late, run.truth[:, 0] > times)
    np.testing.assert_allclose(run.errors, [z for z, _ in run.calls] - times)


def test_no_angle_of_an_encoder_lies_where_rounding_decides():
    for seed in range(200):
        rng = np.random.default_rng(seed)
        per_turn = int(rng.integers(7, 500))
        counts = sensor_bundles.angles_between_counts(rng, 600, 10 * per_turn, per_turn)
        twice = 2 * counts * per_turn / (2 * math.pi)
        assert np.min(np.abs(twice - np.rint(twice))) > 0.01


@pytest.mark.parametrize("gain", [0.0, 0.2, 0.6, 1.0, 1.5, 2.0, 3.0])
def test_a_correction_of_any_gain_the_readme_allows_closes_the_loop(gain):
    def command(twin, target):
        return twin["friction"] * target + gain * (target - twin["speed"])

    for seed in range(40):
        twin_bundles.expect_command_closes_loop(Fake("command", command), np.random.default_rng(seed))


def test_a_twin_that_passes_the_measurement_on_is_never_good_enough():
    def passes_on(twin, z, t):
        out = right.sync(twin, z, t)
        return {**out, "position": z} if t >= twin["t"] else out

    for seed in range(20):
        for late, sign in ((0.0, 1.0), (0.33, -1.0)):
            with pytest.raises(kit.CheckFailed):
                twin_bundles.expect_keeps_up(
                    Fake("sync", passes_on), np.random.default_rng(seed), sign=sign, late=late, message="it"
                )


def test_arcs_by_their_radius_and_by_the_chord_meet():
    for turn in (0.0299999, 0.0300001):
        wheels = (0.5 - turn / 4, 0.5 + turn / 4, 0.5, 1.0)
        expected = right.diff_drive_step((1.0, 2.0, 0.7), *wheels)
        assert actuator_bundles.arc_end((1.0, 2.0, 0.7), wheels) == pytest.approx(expected, abs=1e-12)


def test_the_report_describes_the_actuators_and_the_gyroscope_that_were_drawn():
    def described(submission):
        submission.fold = lambda name, start, calls: _folded(submission, name, start, calls)
        shown = kit.companion("digital-twin", "report")
        return [make(submission).plot.description for make in (shown._at_rest, shown._actuators)]

    def _folded(submission, name, start, calls):
        values = [start]
        for arguments in calls:
            values.append(submission.call(name, values[-1], *arguments))
        return values

    def restless(rate, *arguments):
        bias = np.linspace(0.0, 3.0, len(rate))
        return rate + bias + 0.02 * np.random.default_rng(1).standard_normal(len(rate)), bias

    usual = described(Fake())
    assert "a bias that starts at 0.05" in usual[0]
    gyroscope = described(Fake("imu", restless))[0]
    assert "starts at 0 rad/s, ends at 3" in gyroscope
    prompt = described(Fake("delay_line", lambda signal, dt, delay: signal))[1]
    numbers = re.search(r"your motor at (\S+) s, .* your delayed signal at (\S+) s", usual[1])
    assert float(numbers[2]) > float(numbers[1])
    numbers = re.search(r"your motor at (\S+) s, .* your delayed signal at (\S+) s", prompt)
    assert numbers[1] == numbers[2]


def test_the_drive_of_the_report_makes_streams_that_a_bag_can_hold():
    from course.simulations import streams

    found = kit.companion("digital-twin", "drive").streams(Fake())
    assert [type(stream).__name__ for stream in streams.streams_from(found)] == [
        "ImuStream",
        "ScanStream",
        "OdometryStream",
        "TruthStream",
    ]


def test_each_scan_of_the_drive_has_a_pose_of_its_own_time_in_both_odometries():
    found = kit.companion("digital-twin", "drive").streams(Fake())
    for kind in ("odometry", "truth"):
        assert set(found["scan"]["t"]) <= set(found[kind]["t"])
        x, y, t = found[kind]["x"], found[kind]["y"], found[kind]["t"]
        travelled = np.hypot(np.diff(x), np.diff(y)) / np.diff(t)
        # A chord is shorter than its arc, here by one part in 10,000; encoders are read in whole counts.
        assert np.allclose(travelled, found[kind]["speed"][1:], rtol=1e-3, atol=1e-9)

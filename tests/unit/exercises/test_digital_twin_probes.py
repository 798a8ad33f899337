"""Probes of ``digital-twin`` on programs that are on no record, and what its checks stand on."""

from __future__ import annotations

import copy
import importlib.util
import inspect
import math
import re
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

ROOT = Path(__file__).resolve().parents[3]
SOLUTION = ROOT / "solutions" / "digital-twin"
spec = importlib.util.spec_from_file_location("digital_twin_solution", SOLUTION / "digital_twin.py")
right = importlib.util.module_from_spec(spec)
spec.loader.exec_module(right)

scanners = kit.companion("digital-twin", "lidar_probes")
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


@pytest.mark.parametrize("place", [lambda ends: ends, lambda ends: ends.mean(axis=1, keepdims=True)])
def test_a_scanner_that_leaves_long_walls_out_is_told_so_and_nothing_of_its_noise(place):
    def culls(pose, walls, angles, r_max, *rest):
        walls = np.reshape(walls, (-1, 2, 2))
        far = np.linalg.norm(place(walls) - np.asarray(pose)[:2], axis=2).min(axis=1)
        return right.lidar(pose, walls[far <= r_max], angles, r_max, *rest)

    assert scanners.of_lidar(Fake("lidar", culls)).code == "LONG_WALL_LEFT_OUT"
    assert scanners.of_lidar_noise(Fake("lidar", culls)) is None


def test_noise_is_no_reason_for_what_is_wrong_without_it():
    def cut(*args):
        return np.minimum(right.lidar(*args), args[3])

    assert scanners.of_lidar(Fake("lidar", cut)).code == "NOISE_CUT_AT_MAX"
    assert scanners.of_lidar(Fake("lidar", cut), noisy=False) is None


@pytest.mark.parametrize("seed", range(20))
def test_the_long_wall_of_the_graders_is_hit_before_the_short_one(seed):
    rng = np.random.default_rng(seed)
    rays = kit.sibling(ROOT / "tests/graders/digital-twin/parts.py", "rays")
    walls = rays.long_before_short((0.3, -0.4, 1.0), rng)
    size = np.hypot(*(walls[:, 1] - walls[:, 0]).T)
    long, short = walls[np.argmax(size)], walls[np.argmin(size)]
    place = np.array([0.3, -0.4])
    ends = [sorted(np.hypot(*(wall - place).T)) for wall in (short, long)]
    assert ends[0][1] < ends[1][0]
    to_short = np.mean(short, axis=0) - place
    pose, angle = (*place, 0.0), np.array([math.atan2(to_short[1], to_short[0])])
    behind = rays.distances(pose, short[None], angle, 20.0)[0]
    assert rays.distances(pose, walls, angle, 20.0)[0] < behind - 0.2


def test_a_noise_that_is_not_finite_is_not_said_to_differ_with_the_same_generator():
    def imu(*args):
        measured, bias = right.imu(*args)
        measured[0] = math.nan
        return measured, bias

    with pytest.raises(kit.CheckFailed) as failed:
        sensor_bundles.expect_gyroscope_draws(LocalSubmission("", replaced={"imu": imu}), 5, 0.02)
    assert "a walk together, the std of " in failed.value.finding.message


def test_densities_that_are_right_are_not_said_to_be_too_small():
    found, cases = np.tile([1.0 - 1e-4, 1.1], 4), [(np.ones(9), 0.01, 1.0)] * 8
    assert sensors.of_density(found, cases) is None
    assert sensors.of_density(np.tile([0.9, 1.1], 4), cases).code == "DENSITY_SCATTERS"


def test_calls_in_a_row_change_one_argument_each():
    bundles = kit.companion("digital-twin", "bundles")
    assert bundles.one_by_one((1, 2), (3, 4)) == [(1, 2), (3, 2), (1, 4)]


@pytest.mark.parametrize("key", range(3))
def test_a_gear_that_looks_its_answer_up_by_two_of_three_arguments_is_caught(key):
    known = {}

    def backlash(*args):
        return known.setdefault(args[:key] + args[key + 1 :], right.backlash(*args))

    parts = kit.sibling(ROOT / "tests/graders/digital-twin/checks.py", "parts")
    with pytest.raises(kit.CheckFailed):
        parts.expect_swings(Fake("backlash", backlash), np.random.default_rng(3))


def test_the_room_of_the_checks_reads_as_the_model_solution_sees_it():
    rng, angles = np.random.default_rng(3), np.linspace(-3.1, 3.1, 90)
    for _ in range(20):
        pose = rng.uniform((0.3, 0.3, -3.0), (5.7, 3.7, 3.0))
        ranges = right.lidar(pose, scenes.ROOM, angles, 4.0, 0.0, rng)
        np.testing.assert_allclose(ranges, scenes.room_ranges(pose, angles, 4.0), atol=1e-9)


@pytest.mark.parametrize(
    ("seconds", "code"), [(0.02, "BIAS0_TIME_TOO_SHORT"), (0.6, None), (20.0, "BIAS0_TIME_TOO_LONG")]
)
def test_a_bias_that_is_the_mean_of_another_stretch_is_told_so(seconds, code):
    cases = [
        (scenes.recording(np.random.default_rng(i), 8000, 0.01, 0.002, 0.006, -0.1), 0.01, 0.002, 0.006, -0.1)
        for i in range(4)
    ]
    found = np.array([np.mean(still[: round(seconds / dt)]) for still, dt, *_ in cases])
    assert getattr(sensors.of_bias0(found, cases), "code", None) == code


FITS = LocalSubmission("", replaced={"fit_noise": right.fit_noise})


def _squared(still, dt):
    found = right.fit_noise(still, dt)
    return {**found, "bias_random_walk": found["bias_random_walk"] ** 2}


def test_a_walk_is_a_square_only_if_it_grows_like_one():
    cases = sensor_bundles.recordings(np.random.default_rng(2), 8, lambda: (0.01, 0.002, 0.003, 0.05))
    squares = np.array([_squared(case[0], case[1])["bias_random_walk"] for case in cases])
    squared = LocalSubmission("", replaced={"fit_noise": _squared})
    assert sensors.of_walk(squares, cases, squared).code == "ROOT_FORGOTTEN"
    assert sensors.of_walk(squares, cases, FITS).code == "WALK_TOO_SMALL"  # near the square by chance


def test_walks_and_biases_are_told_what_is_known_of_them_and_no_more():
    rng = np.random.default_rng(2)
    cases = sensor_bundles.recordings(rng, 8, lambda: (0.01, 0.002, 0.003, 0.05))
    walks = np.array([case[3] for case in cases])
    biases = np.array([case[4] for case in cases])
    assert min(biases) < 0 < max(biases)
    for code, factor in (("WALK_WITHOUT_THREE", 3**-0.5), ("WALK_TOO_SMALL", 0.2), ("WALK_TOO_LARGE", 1.7)):
        assert sensors.of_walk(factor * walks, cases, FITS).code == code
    assert (
        sensors.of_walk(3**-0.5 * walks * np.tile([0.3, 0.8, 1.2, 1.6], 2), cases, FITS).code
        != "WALK_WITHOUT_THREE"
    )
    neighbours = np.array([np.std(np.diff(case[0])) / 0.1 for case in cases])
    assert sensors.of_walk(neighbours, cases, FITS).code == "NOISE_COUNTED_AS_DRIFT"
    assert sensors.of_bias0(np.abs(biases), cases).code == "BIAS0_WITHOUT_SIGN"
    assert sensors.of_bias0(biases + 1.0, cases) is None


def test_a_right_twin_is_told_no_mistake():
    assert twins.of_sync(Fake()) is None
    assert twins.of_command(Fake()) is None
    assert sensors.of_imu(Fake()) is None
    assert scanners.of_lidar(Fake()) is None
    assert actuators.of_drive(Fake()) is None


def test_a_command_that_remembers_is_told_nothing_of_single_calls():
    total = []

    def summing(twin, target):
        total.append(0.1 * (target - twin["speed"]))
        return 0.5 * sum(total) + twin["friction"] * target

    assert twins.of_command(Fake("command", summing)) is None


def test_a_twin_that_runs_away_by_and_by_is_no_twin_that_is_nan():
    def run(sync):
        with pytest.raises(kit.CheckFailed) as failed:
            twin_bundles.expect_keeps_up(
                Fake("sync", sync), np.random.default_rng(1), sign=1.0, late=0.0, message="it"
            )
        return failed.value

    flown = run(shares(("- b * v", "+ b * v")))
    assert flown.guess.code == "FRICTION_SPEEDS_UP"
    assert "its `speed` is beyond" in flown.finding.message
    late = run(lambda twin, z, t: {**right.sync(twin, z, t), "t": 1e9})
    assert "its `t` is beyond a million" in late.finding.message
    broken = run(lambda twin, z, t: {**right.sync(twin, z, t), "position": math.nan})
    assert "runs away" not in broken.finding.message


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


@pytest.mark.parametrize(
    ("adds", "code"),
    [
        (lambda off: 0.05 * np.sign(off), "CORRECTION_JUMPS"),
        (lambda off: 5.0 * np.sign(off), "CORRECTION_JUMPS"),
        (lambda off: np.clip(10.0 * off, -0.4, 0.4), "GAIN_TOO_LARGE"),
        (lambda off: np.clip(3.0 * off, -0.4, 0.4), None),
        (lambda off: 3.0 * off * (abs(off) > 0.05), None),
    ],
)
def test_a_correction_has_to_go_to_zero_at_the_target_speed(adds, code):
    def command(twin, target):
        return twin["friction"] * target + float(adds(target - twin["speed"]))

    assert told("command", command) == code
    seen = None
    try:
        twin_bundles.expect_command_closes_loop(Fake("command", command), np.random.default_rng(0))
    except kit.CheckFailed as failed:
        seen = failed.guess.code
    assert seen == code


def test_the_noise_of_a_scan_is_that_of_one_reading_and_not_of_the_smaller_of_two():
    def of_each_wall(pose, walls, *rest):
        scans = [right.lidar(pose, wall[None], *rest) for wall in walls]
        return np.min(scans, axis=0)

    for seed in range(10):
        rng = np.random.default_rng(seed)
        asked = rng.uniform(6.0, 9.0), rng.uniform(0.02, 0.08), rng
        sensor_bundles.expect_scan_noise(Fake(), *asked)
        with pytest.raises(kit.CheckFailed) as failed:
            sensor_bundles.expect_scan_noise(Fake("lidar", of_each_wall), *asked)
        assert failed.value.guess.code == "NOISE_BEFORE_NEAREST"


@pytest.mark.parametrize(
    ("skips", "code"),
    [
        (lambda walls: walls[:, 0, 0] == walls[:, 1, 0], "WALLS_ALONG_AXES_MISSED"),
        (lambda walls: walls[:, 0, 1] == walls[:, 1, 1], "WALLS_ALONG_AXES_MISSED"),
        (lambda walls: walls[:, 0, 0] > -99.0, None),
    ],
)
def test_walls_along_an_axis_are_said_to_be_missed_only_where_slanted_ones_are_seen(skips, code):
    def lidar(pose, walls, *rest):
        return right.lidar(pose, walls[~skips(walls)], *rest)

    assert told("lidar", lidar) == code


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


def test_another_drive_begins_where_the_twin_is_in_time():
    times = 0.1 * np.arange(1, 101)
    drives = np.where(times < 5.05, 0.5, 1.5)
    cart = scenes.Cart(((0.0, 0.5),), v=1.0)
    run = scenes.measured(cart, drives, times, np.random.default_rng(2), late=0.6)
    begins = int(np.argmax(run.drives == 1.5))
    assert run.truth[begins - 1, 0] == pytest.approx(5.0)
    assert np.all(run.drives[:begins] == 0.5)
    assert np.all(run.drives[begins:] == 1.5)
    late_after = run.late[begins:] & (np.array([t for _, t in run.calls[begins:]]) < 5.0)
    assert late_after.any()  # what was measured under the old drive comes under the new one
    assert run.truth[-1, 2] > 2.5


@pytest.mark.parametrize("task", ["imu", "lidar"])
def test_a_generator_that_is_copied_is_noticed(task):
    def copies(*args):
        return getattr(right, task)(*args[:-1], copy.deepcopy(args[-1]))

    def makes_a_generator_of_its_own(*args):
        return getattr(right, task)(*args[:-1], np.random.default_rng(args[-1].integers(2**32)))

    checks = {
        "imu": lambda submission: sensor_bundles.expect_gyroscope_draws(submission, 5, 0.02),
        "lidar": lambda submission: sensor_bundles.expect_scan_draws(submission, 5),
    }
    for function in (getattr(right, task), makes_a_generator_of_its_own):
        checks[task](LocalSubmission("", replaced={task: function}))
    with pytest.raises(kit.CheckFailed) as failed:
        checks[task](LocalSubmission("", replaced={task: copies}))
    assert failed.value.guess.code == "GENERATOR_COPIED"


def test_a_tour_turns_to_either_side():
    parts = kit.sibling(ROOT / "tests/graders/digital-twin/checks.py", "parts")

    def chord_to_one_side(pose, v_left, v_right, track, dt):
        right_turn = v_right < v_left
        return (
            right_way(pose, v_left, v_right, track, dt)
            if right_turn
            else _straight(pose, v_left, v_right, dt)
        )

    def _straight(pose, v_left, v_right, dt):
        way = (v_left + v_right) / 2 * dt
        return np.array([pose[0] + way * np.cos(pose[2]), pose[1] + way * np.sin(pose[2]), pose[2]])

    right_way = right.diff_drive_step
    for seed in range(8):
        turns = []

        def noted(pose, *wheels, turns=turns):
            turns.append(wheels[1] - wheels[0])
            return right_way(pose, *wheels)

        parts.expect_tour(Fake("diff_drive_step", noted), np.random.default_rng(seed))
        assert min(turns) < 0 < max(turns)
        with pytest.raises(kit.CheckFailed):
            parts.expect_tour(Fake("diff_drive_step", chord_to_one_side), np.random.default_rng(seed))


def test_the_first_wrong_step_of_a_gear_has_a_number_and_no_time():
    with pytest.raises(kit.CheckFailed) as failed:
        actuator_bundles.expect_play(
            Fake("backlash", lambda x, gap, state: (state, state)),
            [0.0, 0.1, 3.0],
            1.0,
            [0.0] * 3,
            [0.0, 0.0, 2.5],
        )
    assert failed.value.finding.first_divergence is None
    assert failed.value.finding.input == {"step": 2, "x": 3.0, "gap": 1.0, "state": 0.0}


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
    from course.simulations import bags as streams

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


def test_without_latency_the_first_sample_counts_and_rounding_excuses_nothing():
    def strict(x, dt, latency):
        return np.where(dt * np.arange(len(x)) > latency, right.delay_line(x, dt, latency), 0.0)

    x = np.array([2.0, -3.0, 1.0])
    actuator_bundles.expect_delayed(Fake(), strict(x, 0.1, 0.2), x, 0.1, 0.2, [0.0, 0.0, 2.0])
    with pytest.raises(kit.CheckFailed):
        actuator_bundles.expect_new_signal(Fake("delay_line", strict), x, 0.1)


def test_readings_that_miss_a_wall_are_not_blamed_on_the_noise():
    def joined(pose, segments, angles, r_max, sigma, rng):
        starts = np.asarray(segments)[:, 0]
        walls = np.stack([starts, np.roll(starts, -1, axis=0)], axis=1)
        return right.lidar(pose, walls, angles, r_max, sigma, rng)

    with pytest.raises(kit.CheckFailed) as failed:
        sensor_bundles.expect_scan_noise(Fake("lidar", joined), 8.0, 0.05, np.random.default_rng(1))
    assert "readings do not scatter about its distances" in failed.value.finding.message


def counts_in_single_precision(theta, counts_per_rev):
    turns = np.float32(theta) / np.float32(2 * np.pi)
    return np.floor(turns * np.float32(counts_per_rev)).astype(np.int64)


def play_without_small_steps(x, gap, state):
    y, _ = right.backlash(x, gap, state)
    return (state, state) if abs(y - state) < 1e-3 * gap else (y, y)


def test_angles_beside_a_count_tell_single_precision():
    bundles = kit.companion("digital-twin", "sensor_bundles")
    theta = bundles.angles_beside_counts(np.linspace(-51000, 51000, 20), 64)
    bundles.expect_counts(None, right.encoder(theta, 64), theta, 64)
    with pytest.raises(kit.CheckFailed):
        bundles.expect_counts(
            Fake("encoder", counts_in_single_precision), counts_in_single_precision(theta, 64), theta, 64
        )


def test_small_steps_of_a_gear_count():
    play = kit.companion("digital-twin", "actuator_bundles").expect_play
    asked = [1.50001], 1.0, [1.0], [1.00001]
    play(Fake(), *asked)
    with pytest.raises(kit.CheckFailed):
        play(Fake("backlash", play_without_small_steps), *asked)


@pytest.mark.parametrize("seed", [None, 0, 1, 4])
def test_a_mistake_in_a_fit_is_named_alike_whatever_recordings_a_run_draws(seed):
    def of_the_whole(still, dt):
        """Near the walk where walk and density are alike, as in the recordings of the public check."""
        std = np.std(still)
        walk = std / math.sqrt(dt * len(still))
        return {"noise_density": std * math.sqrt(dt), "bias_random_walk": walk, "bias0": still[0]}

    rng = np.random.default_rng(seed or 0)
    like_at_home = 0.01, 0.002, 0.003, 0.05
    make = (lambda: like_at_home) if seed is None else (lambda: sensor_bundles.unknown_gyroscope(rng))
    with pytest.raises(kit.CheckFailed) as failed:
        sensor_bundles.expect_fits(Fake("fit_noise", of_the_whole), sensor_bundles.recordings(rng, 8, make))
    assert failed.value.guess.code == "DRIFT_COUNTED_AS_NOISE"


# -- a mistake with the effect of another is not told that one -----------------------------------------------


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
    # Numbers between two limits: of the right size, and of another.
    ("WHITE_NOISE_NOT_NORMAL", [(NOISE + " * rng.standard_normal(n)", NOISE + " * rng.uniform(-1, 1, n)")]),
    ("BIAS_STEPS_NOT_NORMAL", [(DRAWN, "rng.uniform(-1, 1, n - 1)")]),
    ("BIAS_STEPS_NOT_NORMAL", [(DRAWN, "np.sign(rng.standard_normal(n - 1))")]),
    ("WHITE_NOISE_FACTOR", [("/ math.sqrt(dt) * rng", "/ 2 / math.sqrt(dt) * rng")]),
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


def test_a_heading_that_slow_turns_leave_is_a_reason_for_headings_only():
    kept = changed("diff_drive_step", ("heading + turn]", "heading + turn * (abs(turn) > 1e-3)]"))
    pose, wheels = np.array([1.0, 2.0, 0.5]), (0.3, 0.3 + 1e-5, 0.4, 1.0)
    value = kept(pose, *wheels)
    _, code = failed(actuator_bundles.expect_pose, Fake("diff_drive_step", kept), value, pose, wheels)
    assert code == "SLOW_TURN_NOT_TURNED"
    assert told("diff_drive_step", kept) is None


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
    ("FRICTION_SIGN_OF_DRIVE", [("np.sign(v)", "np.sign(twin['drive'])")]),
    ("LARGE_SURPRISES_DROPPED", [("z - x", "(z - x) * (abs(z - x) < 2 * twin['sigma'])")]),
    ("SURPRISE_OF_OLD_POSITION", [("z - x", "z - twin['position']")]),
    (None, [("z - x", "float(np.clip(z - x, -2 * twin['sigma'], 2 * twin['sigma']))")]),
]


@pytest.mark.parametrize(("code", "changes"), SYNC, ids=[f"{i}-{code}" for i, (code, _) in enumerate(SYNC)])
def test_a_twin_is_told_no_other_mistake_of_the_same_effect(code, changes):
    assert told("sync", shares(*changes)) == code


def test_a_late_measurement_that_is_rolled_back_to_under_the_present_drive_is_told_so():
    in_time = shares()

    def predicted(twin, t):
        state = np.array([twin["position"], twin["speed"], twin["friction"]])
        return right._predict(state, np.zeros((3, 3)), twin["drive"], t - twin["t"])[0]

    def back_and_forth(twin, z, t):
        if t >= twin["t"]:
            return in_time(twin, z, t)
        x, v, _ = predicted(twin, t)
        then = {**twin, "t": t, "position": x + 0.3 * (z - x), "speed": v + 0.3 * (z - x)}
        x, v, _ = predicted(then, twin["t"])
        return {**twin, "position": x, "speed": v}

    assert told("sync", back_and_forth) == "PAST_WITH_NEW_DRIVE"


@pytest.mark.parametrize(("limits", "stops"), [((0.3, 0.9), True), ((0.45, 5.0), True), ((0.05, 5.0), False)])
def test_a_limit_is_told_where_a_friction_stopped_at_it(limits, stops):
    limited = shares(("0.05), 5.0)", f"{limits[0]}), {limits[1]})"))
    said = twins.of_sync(Fake("sync", limited), stops=True)
    assert (said is not None and said.code == "FRICTION_LIMITED") == stops
    assert twins.of_sync(Fake("sync", limited)) is None


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

"""The diagnosis of ``digital-twin``: what the probes see, and what the known wrong programs answer."""

from __future__ import annotations

import copy
import importlib.util
import math
import re
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit
from course.scoring.explain.fingerprint import fingerprint, read
from course.scoring.explain.story import is_right, matching, read_table

ROOT = Path(__file__).resolve().parents[3]
SOLUTION = ROOT / "solutions" / "digital-twin"
spec = importlib.util.spec_from_file_location("digital_twin_solution", SOLUTION / "digital_twin.py")
right = importlib.util.module_from_spec(spec)
spec.loader.exec_module(right)

questions = kit.companion("digital-twin", "questions")
table = read_table(ROOT / "exercises" / "digital-twin")
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


def fits(task, wrong):
    """Codes of the known programs that answer every question as this function does."""

    def answer(args):
        seeded = [
            np.random.default_rng(int(a.integers(2**62))) if isinstance(a, np.random.Generator) else a
            for a in copy.deepcopy(args)
        ]
        with np.errstate(all="ignore"):
            return read(wrong(*seeded), questions.READ.get(task))

    sums = fingerprint([answer(args) for args in questions.QUESTIONS[task]])
    if is_right(table, task, sums):
        return ["right"]
    return [code for row in matching(table, task, sums) for code in row.codes]


def recognised(task, wrong, probe):
    """Codes of what this function is told: by a known program that answers alike, or else by the probe."""
    found = fits(task, wrong)
    return found if found else [getattr(probe(Fake(task, wrong)), "code", None)]


def imu(white=1.0, step=1.0, power=-0.5, step_power=0.5, add=1.0, seed=None):
    """An imu with its factors, powers of dt and sign as given."""

    def wrong(true, dt, density, walk, bias0, rng):
        rng = rng if seed is None else np.random.default_rng(seed)
        n = len(true)
        steps = step * walk * dt**step_power * rng.standard_normal(n - 1)
        bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
        return true + add * bias + white * density * dt**power * rng.standard_normal(n), bias

    return wrong


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
    assert scanners.of_lidar(Fake("lidar", wrong)).code == code


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
    ("CHORD_WRONG_LENGTH", drive(lambda turn, h: (turn, np.cos(turn), h + turn / 2))),
    ("CHORD_WRONG_WAY", drive(lambda turn, h: (turn, chord(turn), h + turn / 3))),
    (None, drive(lambda turn, h: (turn, chord(turn) * (0.9 if 0 < turn < 0.5 else 1.0), h + turn / 2))),
]


@pytest.mark.parametrize(("code", "wrong"), STEPS, ids=[f"{i}-{c}" for i, (c, _) in enumerate(STEPS)])
def test_slow_turns_are_blamed_only_where_an_ordinary_one_is_right(code, wrong):
    assert code in recognised("diff_drive_step", wrong, actuators.of_drive)


def shares(old="", new=""):
    """The sync of constant shares, with ``new`` in place of ``old``."""
    source = (SOLUTION / "accepted" / "constant_shares.py").read_text(encoding="utf-8")
    assert old in source
    space = dict(vars(right))
    exec(source.replace(old, new), space)
    return space["sync"]


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


def test_memory_that_grows_is_seen_before_it_is_too_large():
    def keeps_all(twin, z, t):
        out = shares()(twin, z, t)
        return {**out, "memory": {"all": [*twin["memory"].get("all", []), z]}}

    with pytest.raises(kit.CheckFailed) as failed:
        twin_bundles.expect_twin_contract(Fake("sync", keeps_all), np.random.default_rng(7))
    assert failed.value.guess.code == "MEMORY_GROWS"


def test_a_twin_that_runs_away_by_and_by_is_no_twin_that_is_nan():
    def run(sync):
        with pytest.raises(kit.CheckFailed) as failed:
            twin_bundles.expect_keeps_up(
                Fake("sync", sync), np.random.default_rng(1), sign=1.0, late=0.0, message="it"
            )
        return failed.value

    flown = run(shares("- b * v", "+ b * v"))
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


def _late_under_new_drives(twin, z, t, replay):
    """Constant shares; a late measurement is fitted in, and ``replay`` says which drive its past has."""
    memory = twin["memory"]
    rows = memory.get(
        "rows", [[twin["t"], twin["position"], twin["speed"], twin["friction"], twin["drive"], 0.0]]
    )
    rows = [list(row) for row in rows]
    rows[-1][4] = twin["drive"]
    later = [row for row in rows if row[0] > t]
    rows = rows[: len(rows) - len(later)]
    for at, seen in [(t, z), *((row[0], row[5]) for row in later)] if rows else []:
        old = rows[-1]
        acted = replay(old[4], twin["drive"])
        start = scenes.new_twin(old[3], acted, speed=old[2], position=old[1], t=old[0])
        new = _by_constant_shares(start, seen, at)
        on = next((row[4] for row in later if row[0] == at), old[4])
        rows.append([at, new["position"], new["speed"], new["friction"], on, seen])
    rows = (rows or later)[-20:]
    now, x, v, b = rows[-1][:4]
    return {**twin, "t": now, "position": x, "speed": v, "friction": b, "memory": {"rows": rows}}


def _by_constant_shares(twin, z, t):
    dt, v, b = t - twin["t"], twin["speed"], twin["friction"]
    a = twin["drive"] - b * v
    x, v = twin["position"] + dt * v + dt * dt / 2 * (a - dt / 3 * b * a), v + dt * a - dt * dt / 2 * b * a
    s = z - x
    return {"position": x + 0.3 * s, "speed": v + 0.3 * s, "friction": b - 0.15 * s * float(np.sign(v))}


@pytest.mark.parametrize("seed", range(6))
def test_the_past_is_that_of_the_drives_that_acted_then(seed):
    def in_its_time(twin, z, t):
        return _late_under_new_drives(twin, z, t, lambda then, today: then)

    def of_today(twin, z, t):
        return _late_under_new_drives(twin, z, t, lambda then, today: today)

    twin_bundles.expect_follows_drives(Fake("sync", in_its_time), np.random.default_rng(seed))
    with pytest.raises(kit.CheckFailed) as failed:
        twin_bundles.expect_follows_drives(Fake("sync", of_today), np.random.default_rng(seed))
    assert failed.value.guess.code == "PAST_WITH_NEW_DRIVE"
    assert twins.of_sync(Fake("sync", in_its_time)) is None


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

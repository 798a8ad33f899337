"""Probes of ``digital-twin`` on programs that are on no record, and what its checks stand on.

What known wrong programs are told is in ``solutions/digital-twin/record.json``, which the audit keeps.
"""

import inspect
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

ROOT = Path(__file__).resolve().parents[3]
SHARES = (ROOT / "solutions/digital-twin/accepted/constant_shares.py").read_text("utf-8")
right = kit.reference("digital-twin", "digital_twin")
parts = kit.sibling(ROOT / "tests/graders/digital-twin/checks.py", "parts")

scanners = kit.companion("digital-twin", "lidar_probes")
sensors = kit.companion("digital-twin", "sensor_probes")
actuators = kit.companion("digital-twin", "actuator_probes")
twins = kit.companion("digital-twin", "twin_probes")
actuator_bundles = kit.companion("digital-twin", "actuator_bundles")
sensor_bundles = kit.companion("digital-twin", "sensor_bundles")
twin_bundles = kit.companion("digital-twin", "twin_bundles")
scenes = kit.companion("digital-twin", "scenes")

PROBES = {
    "imu": sensors.of_imu,
    "lidar": scanners.of_lidar,
    "motor_step": actuators.of_motor,
    "backlash": actuators.of_backlash,
    "delay_line": actuators.of_delay,
    "diff_drive_step": actuators.of_drive,
    "sync": twins.of_sync,
    "command": twins.of_command,
}


def program(**functions):
    """The model solution with some functions replaced."""
    return LocalSubmission(inspect.getsource(right), replaced=functions)


def changed(task, *changes):
    """The model solution, or a sync with constant shares, with each (old, new) exchanged in a function."""
    source = SHARES if task == "sync" else inspect.getsource(getattr(right, task))
    for old, new in changes:
        assert old in source, old
        source = source.replace(old, new)
    return LocalSubmission(f"{inspect.getsource(right)}\n\n{source}")


def told(task, submission):
    """The code that the probes of a task give a program."""
    return getattr(PROBES[task](submission), "code", None)


DRAWN = "rng.standard_normal(n - 1)"
#: It remembers, of which single calls show nothing.
SUMS = [
    ("speed):", "speed, total=[]):\n    total.append(0.1 * (target_speed - twin['speed']))"),
    ("return ", "return 0.5 * sum(total) + "),
]


@pytest.mark.parametrize(
    ("code", "task", "changes"),
    [
        *((None, task, []) for task in ("imu", "lidar", "motor_step", "diff_drive_step", "sync", "command")),
        (None, "imu", [("true + bias", "dt * true + bias")]),
        (None, "imu", [("bias0 + np", "0 * bias0 + 0.7 + np")]),  # not carried over
        # Single precision is neither a step too many nor another bias.
        (None, "imu", [("bias0 + np", "np.float32(bias0) + np")]),
        (None, "imu", [("return true + bias", "return np.float32(true + bias)")]),
        ("BIAS_DRIFTS", "imu", [(DRAWN, "np.full(n - 1, rng.standard_normal())")]),
        ("BIAS_STEPS_RELATED", "imu", [("np.cumsum(steps)", "np.cumsum(np.cumsum(steps))")]),
        (None, "lidar", [("heading = pose", "heading = 0.0, *pose[1:]")]),  # it moves in one coordinate
        (None, "lidar", [("reshape(-1, 2, 2)", "reshape(-1, 2, 2)[:0]")]),  # it sees no wall at all
        ("GAP_SCALED", "backlash", [("gap / 2", "0.6 * gap")]),
        (None, "delay_line", [("np.interp(t - latency, t, x, left=0.0)", "np.where(t >= latency, x, 0.0)")]),
        # A reason for headings only, where the place is asked about.
        (None, "diff_drive_step", [("heading + turn]", "heading + turn * (abs(turn) > 1e-3)]")]),
        (None, "command", SUMS),
        ("TIME_NOT_THE_LATEST", "sync", [('"t": t_measured', '"t": twin["t"] + 0.3 * dt')]),
        ("SMALL_SURPRISES_IGNORED", "sync", [("z - x", "(z - x) * (abs(z - x) > 3 * twin['sigma'])")]),
        ("PREDICTS_TOO_LITTLE", "sync", [("dt / n * v", "dt / n * v / 2")]),
        ("SHARE_OVER_ONE", "sync", [("x + 0.3", "x + 1.5")]),
        (
            "SURPRISE_LIMITED",
            "sync",
            [("z - x", "float(np.clip(z - x, -2 * twin['sigma'], 2 * twin['sigma']))")],
        ),
        (None, "sync", [("0.05), 5.0)", "0.3), 0.9)")]),  # where a friction stops at a limit is asked for
        (None, "sync", [("- 0.15", "- 0.5")]),
        *(("FRICTION_SHARE_TOO_LARGE", "sync", [("- 0.15", share)]) for share in ("- 3.0", "- 1.5")),
        ("FRICTION_WITHOUT_SPEED", "sync", [("- b * v", "- b * x")]),
        ("FRICTION_NOT_IN_MODEL", "sync", [(" - b * v", "")]),
        (
            "POSITION_OF_OLD_SPEED",
            "sync",
            [("x + dt / n * v + (dt / n) ** 2 / 2 * a", "x + dt / n * twin['speed']")],
        ),
        ("FRICTION_LEARNS_SLOWLY", "sync", [("- 0.15", "- 0.02")]),
    ],
)
def test_a_program_is_told_no_other_mistake_of_the_same_effect(code, task, changes):
    assert told(task, changed(task, *changes)) == code


def culls(pose, walls, angles, r_max, *rest):
    """It leaves out walls of which both ends are far away, long ones as well."""
    walls = np.reshape(walls, (-1, 2, 2))
    far = np.linalg.norm(walls - np.asarray(pose)[:2], axis=2).min(axis=1)
    return right.lidar(pose, walls[far <= r_max], angles, r_max, *rest)


def test_noise_is_no_reason_for_what_is_wrong_without_it():
    assert scanners.of_lidar(program(lidar=culls)).code == "LONG_WALL_LEFT_OUT"
    assert scanners.of_lidar_noise(program(lidar=culls)) is None
    cut = changed("lidar", ("noisy, r_max)", "np.minimum(noisy, r_max), r_max)"))
    assert scanners.of_lidar(cut, noisy=False) is None


def without_small_steps(x, gap, state):
    y, _ = right.backlash(x, gap, state)
    return (state, state) if abs(y - state) < 1e-3 * gap else (y, y)


def looked_up(key, known):
    """A gear that knows its answer by two of its three arguments."""
    return lambda *args: known.setdefault(args[:key] + args[key + 1 :], right.backlash(*args))


def chord_to_one_side(pose, v_left, v_right, track, dt):
    if v_right < v_left:
        return right.diff_drive_step(pose, v_left, v_right, track, dt)
    way = (v_left + v_right) / 2 * dt
    return np.array([pose[0] + way * np.cos(pose[2]), pose[1] + way * np.sin(pose[2]), pose[2]])


def strict(x, dt, latency):
    """No sample is there before a latency that rounding makes longer."""
    return np.where(dt * np.arange(len(x)) > latency, right.delay_line(x, dt, latency), 0.0)


def counts(theta, per_turn):
    turns = np.float32(theta) / np.float32(2 * np.pi)
    return np.floor(turns * np.float32(per_turn)).astype(np.int64)


THETA = sensor_bundles.angles_beside_counts(np.linspace(-51000, 51000, 20), 64)
X = np.array([2.0, -3.0, 1.0])


@pytest.mark.parametrize(
    ("functions", "check"),
    [
        ({"lidar": culls}, parts.expect_hall),
        *(({"backlash": looked_up(key, {})}, parts.expect_swings) for key in range(3)),
        ({"backlash": without_small_steps}, parts.expect_swings),
        ({"diff_drive_step": chord_to_one_side}, parts.expect_tour),
        ({"encoder": counts}, lambda one, _: sensor_bundles.expect_counts(one, counts(THETA, 64), THETA, 64)),
        ({"delay_line": strict}, lambda one, _: actuator_bundles.expect_new_signal(one, X, 0.1)),
    ],
)
def test_what_is_wrong_at_times_loses_points_whatever_a_run_draws(functions, check):
    for seed in range(8):
        with pytest.raises(kit.CheckFailed):
            check(program(**functions), np.random.default_rng(seed))


def test_without_latency_the_first_sample_counts_and_rounding_excuses_nothing():
    actuator_bundles.expect_delayed(program(), strict(X, 0.1, 0.2), X, 0.1, 0.2, [0.0, 0.0, 2.0])


@pytest.mark.parametrize(
    "correct",
    [
        *(lambda off, gain=gain: gain * off for gain in (0.0, 0.2, 1.0, 2.0, 3.0)),
        lambda off: float(np.clip(3.0 * off, -0.4, 0.4)),
        lambda off: 3.0 * off * (abs(off) > 0.05),
    ],
)
def test_a_correction_that_the_readme_allows_closes_the_loop(correct):
    def command(twin, target):
        return twin["friction"] * target + correct(target - twin["speed"])

    assert told("command", program(command=command)) is None
    for seed in range(20):
        twin_bundles.expect_command_closes_loop(program(command=command), np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("task", "check"),
    [
        ("imu", lambda submission: sensor_bundles.expect_gyroscope_draws(submission, 5, 0.02)),
        ("lidar", lambda submission: sensor_bundles.expect_scan_draws(submission, 5)),
    ],
)
def test_a_generator_of_one_s_own_made_of_the_given_one_is_none_that_is_copied(task, check):
    def own(*args):
        return getattr(right, task)(*args[:-1], np.random.default_rng(args[-1].integers(2**32)))

    check(program(**{task: own}))


def test_what_a_check_does_not_show_is_no_reason_for_its_failure():
    """Beams that do not turn, at a heading of 0; learning forwards only, while a cart rolls forwards."""
    stiff = ("heading + np.asarray(angles", "np.asarray(angles"), ("sigma * rng", "3 * sigma * rng")
    with pytest.raises(kit.CheckFailed) as failed:
        sensor_bundles.expect_scan_noise(changed("lidar", *stiff), 7.0, 0.05, np.random.default_rng(9))
    assert failed.value.guess.code == "SECOND_MISTAKE"
    one_way = changed("sync", (" * np.sign(v)", ""))
    assert twins.of_sync(one_way, {"LEARNS_FORWARDS_ONLY"}).code == "SECOND_MISTAKE"


CASES = sensor_bundles.recordings(np.random.default_rng(2), 8, lambda: (0.01, 0.002, 0.003, 0.05))
WALK, BIAS = (np.array([case[place] for case in CASES]) for place in (3, 4))
DENSITY, SCATTERED = np.full(8, 0.002), np.tile([0.8, 1.2], 4)
#: Near the square by chance, and far too small for some recordings.
SQUARES = np.array([right.fit_noise(*case[:2])["bias_random_walk"] for case in CASES]) ** 2
SMALL = WALK * [0.6, 0.5, 0.01, 0.02, 0.6, 0.05, 0.3, 0.01]


def squared(still, dt):
    found = right.fit_noise(still, dt)
    return {**found, "bias_random_walk": found["bias_random_walk"] ** 2}


def of_bias0_over(seconds):
    known = 0.01, 0.002, 0.006, -0.1
    cases = [(scenes.recording(np.random.default_rng(i), 8000, *known), *known) for i in range(4)]
    return sensors.of_bias0(
        np.array([np.mean(still[: round(seconds / dt)]) for still, dt, *_ in cases]), cases
    )


@pytest.mark.parametrize(
    ("find", "code"),
    [
        (lambda: sensors.of_density(DENSITY * (1 - 1e-4), CASES), None),
        (lambda: sensors.of_density(DENSITY * SCATTERED, CASES, WALK), "DENSITY_SCATTERS"),
        (lambda: sensors.of_density(WALK, CASES, DENSITY), "FIT_SWAPPED"),
        (lambda: sensors.of_walk(SQUARES, CASES, program()), "WALK_TOO_SMALL"),
        (lambda: sensors.of_walk(SMALL, CASES, program()), "WALK_TOO_SMALL"),
        (lambda: sensors.of_walk(1.7 * WALK, CASES, program()), "WALK_TOO_LARGE"),
        (lambda: sensors.of_walk(SQUARES, CASES, program(fit_noise=squared)), "ROOT_FORGOTTEN"),
        (lambda: sensors.of_bias0(BIAS + 1.0, CASES), None),
        (lambda: of_bias0_over(0.6), None),
        (lambda: of_bias0_over(20.0), "BIAS0_TIME_TOO_LONG"),
    ],
)
def test_of_a_fit_is_said_what_its_numbers_show_and_no_more(find, code):
    assert getattr(find(), "code", None) == code

"""Public checks of ``digital-twin``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from course.grading import kit

bundles = kit.companion("digital-twin", "bundles")
scenes = kit.companion("digital-twin", "scenes")
actuators, sensors, twins = bundles.actuators, bundles.sensors, bundles.twins

#: The std of 4000 samples scatters by 1.1 %, so this is five times that.
_SPREAD = 0.06
_SPREAD_SOURCE = "five times the scatter of a std from 4000 samples"


@pytest.mark.task("encoder")
@pytest.mark.points(3)
def test_encoder_counts(submission):
    """An encoder counts whole steps, over several turns and on both sides of zero"""
    theta = np.linspace(-9.0, 9.0, 401) + 0.001
    bundles.expect_counts(submission.call("encoder", theta, 64), theta, 64)


@pytest.mark.task("imu")
@pytest.mark.points(3)
def test_imu_white_noise(submission):
    """White noise is as strong as its density says, at two sampling rates"""
    n, density = 4000, 0.002
    calls = [
        (np.zeros(n), dt, density, 0.0, 0.1, np.random.default_rng(seed))
        for seed, dt in enumerate((0.01, 0.09))
    ]
    for call, (measured, bias) in zip(calls, bundles.imu_pairs(submission, calls), strict=True):
        bundles.expect_std(
            measured - bias,
            density / math.sqrt(call[1]),
            _SPREAD,
            _SPREAD_SOURCE,
            "Without a walk, the spread of the measured rate is not noise_density / sqrt(dt).",
            lambda: sensors.of_imu(submission),
            quantity="std of measured - bias",
            help="A density is per square root of hertz: how many samples share a second?",
            input={"dt": call[1], "noise_density": density, "bias_random_walk": 0.0, "samples": n},
        )


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_bias(submission):
    """The bias starts at bias0, is on the measured rate, and takes steps of the right size"""
    n, dt, walk = 4000, 0.04, 0.01
    true = np.linspace(1.0, -1.0, n)
    given = {"dt": dt, "noise_density": 0.0, "bias_random_walk": walk, "bias0": 0.25, "samples": n}
    calls = [(true, dt, 0.0, walk, 0.25, np.random.default_rng(8))]
    ((measured, bias),) = bundles.imu_pairs(submission, calls)
    kit.expect_close(
        bias[0],
        0.25,
        abs=1e-12,
        source="exact",
        quantity="bias[0]",
        units="rad/s",
        input=given,
        message="The first bias is not bias0.",
        help="bias[0] = bias0; the first step leads to bias[1].",
        diagnose=lambda: sensors.of_imu(submission, bias_first=True),
    )
    bundles.expect_std(
        np.diff(bias),
        walk * math.sqrt(dt),
        _SPREAD,
        _SPREAD_SOURCE,
        "The bias does not step as its random walk says.",
        lambda: sensors.of_imu(submission, bias_first=True),
        quantity="std of the steps",
        help="bias[k+1] = bias[k] + bias_random_walk * sqrt(dt) * a standard normal number.",
        input=given,
    )
    kit.expect_array(
        measured,
        true + bias,
        abs=1e-12,
        source="rounding",
        quantity="measured",
        units="rad/s",
        input=given,
        message="Without white noise, the measured rate is not the true one plus the bias.",
        help="measured[k] = true[k] + bias[k] + white noise.",
        diagnose=lambda: sensors.of_imu(submission, bias_first=True),
    )


@functools.cache
def _recordings():
    """Eight recordings of gyroscopes that drift a lot, two minutes at 100 Hz each."""
    rng = np.random.default_rng(2026)
    cases = []
    for _ in range(8):
        numbers = 0.002 * rng.uniform(0.7, 1.4), 0.003 * rng.uniform(0.7, 1.4), rng.uniform(-0.1, 0.1)
        cases.append((scenes.recording(rng, 12000, 0.01, *numbers), 0.01, *numbers))
    return cases


@pytest.mark.task("fit_noise")
@pytest.mark.points(4)
def test_fit_noise_recordings(submission):
    """From eight recordings at rest, the numbers they were made with are found again"""
    bundles.expect_fits(submission, _recordings(), (0.03, 0.38, 2.1))


@pytest.mark.task("lidar")
@pytest.mark.points(5)
def test_lidar_room(submission):
    """In a room with a door, each beam measures the distance to its wall, and the door reads r_max"""
    angles = np.linspace(-3.1, 3.1, 47)
    poses = ((2.0, 1.7, 0.0), (2.0, 1.7, 0.35), (4.6, 3.1, -2.2))
    calls = [(np.array(pose), scenes.ROOM, angles, 3.5, 0.0, np.random.default_rng(1)) for pose in poses]
    for pose, value in zip(poses, submission.call_each("lidar", calls), strict=True):
        kit.expect_array(
            kit.as_vector(value, len(angles), "ranges"),
            scenes.room_ranges(pose, angles, 3.5),
            abs=1e-9,
            source="rounding",
            quantity="ranges",
            units="m",
            input={"pose": pose, "r_max": 3.5, "sigma": 0.0, "room": "6 m by 4 m, door in the right wall"},
            message="In a known room, without noise, a distance is wrong.",
            help="Take one beam and one wall by hand, then the smallest of all hits.",
            diagnose=lambda: sensors.of_lidar(submission),
        )


@pytest.mark.task("motor_step")
@pytest.mark.points(4)
def test_motor_response(submission):
    """A motor approaches its command as 1 - exp(-t/tau), in fine steps and in coarse ones"""
    tau = 0.2
    dts = np.array([0.05] * 8 + [0.4] * 3 + [5.0] * 3)
    commands = [6.0] * 11 + [25.0, -25.0, 0.3]  # the last three: too large both ways, and swallowed
    t = np.cumsum(dts)
    expected = [*(6.0 * (1 - np.exp(-t[:11] / tau))), 10.0, -10.0, 0.0]
    calls = [(u, float(dt), tau, 10.0, 0.5) for u, dt in zip(commands, dts, strict=True)]
    kit.expect_array(
        [kit.as_number(value, "w_next") for value in submission.fold("motor_step", 0.0, calls)[1:]],
        expected,
        abs=1e-9,
        source="closed form; after 25 time constants the lag is gone",
        quantity="w",
        units="rad/s",
        t=t,
        input={"u": commands, "dt": dts, "tau": tau, "u_max": 10.0, "deadband": 0.5},
        message="The speed of the motor is not what its command, limits and lag make of it.",
        help="In this order: dead band, saturation, then the exact lag.",
        diagnose=lambda: actuators.of_motor(submission),
    )


@pytest.mark.task("backlash")
@pytest.mark.points(3)
def test_backlash_there_and_back(submission):
    """There and back, the output starts late, stays half the gap behind, and rests before it returns"""
    inputs = [0.0, 0.3, 1.0, 2.0, 3.0, 2.6, 2.0, 1.0, 0.0, 0.5, 1.5]
    outputs = [0.0, 0.0, 0.5, 1.5, 2.5, 2.5, 2.5, 1.5, 0.5, 0.5, 1.0]
    expect = bundles.expect_play
    expect(submission, inputs, 1.0, [0.0, *outputs[:-1]], outputs)


@pytest.mark.task("delay_line")
@pytest.mark.points(3)
def test_delay_between_samples(submission):
    """A delay that is no whole number of samples interpolates, and nothing comes out before it"""
    x = np.array([2.0, 3.0, 1.0, 5.0, 4.0, 4.0, 0.0, 2.0])
    expected = [0.0, 0.0, 0.0, 2.75, 1.5, 4.0, 4.25, 4.0]
    bundles.expect_delayed(submission.call("delay_line", x, 0.1, 0.225), x, 0.1, 0.225, expected)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(4)
def test_drive_known_arcs(submission):
    """Straight ahead, on the spot, and round a quarter of a circle to the left"""
    quarter = math.pi / 2
    cases = (
        ((1.0, 2.0, 0.0), (0.5, 0.5, 0.4, 2.0), (2.0, 2.0, 0.0)),
        ((1.0, 2.0, 0.0), (-0.2, 0.2, 0.4, 1.5), (1.0, 2.0, 1.5)),
        ((0.0, 0.0, 0.0), (0.8 * quarter, 1.2 * quarter, 0.4, 1.0), (1.0, 1.0, quarter)),
        ((0.0, 0.0, 3.0), (0.3, 0.3 + 0.4 * quarter, 0.4, 4.0), None),
    )
    calls = [(np.array(pose), *rest) for pose, rest, _ in cases]
    for (pose, rest, end), value in zip(cases, submission.call_each("diff_drive_step", calls), strict=True):
        bundles.expect_pose(
            submission, value, pose, rest, bundles.arc_end(pose, *rest) if end is None else end
        )


@pytest.mark.task("sync")
@pytest.mark.points(6)
def test_sync_follows(submission):
    """A twin that is measured ten times a second keeps up when the friction of the cart jumps"""
    calls, truth = _public_run()
    bundles.expect_follows(
        submission,
        scenes.new_twin(0.5, 0.5, speed=1.0),
        calls,
        truth,
        settled=((2.0, 8.0), (12.0, 24.0)),
        frictions=((3.0, 8.0, 0.5), (16.0, 24.0, 0.8)),
        message="The twin does not stay with its cart.",
    )


@functools.cache
def _public_run():
    cart = scenes.Cart(((0.0, 0.5), (8.0, 0.8)), v=1.0)
    return scenes.measured(cart, 0.5, 0.1 * np.arange(1, 241), np.random.default_rng(4))


@pytest.mark.task("command")
@pytest.mark.points(3)
def test_command_balances(submission):
    """At the target speed, the drive is as large as the friction that the twin believes in"""
    cases = [(0.5, 1.0), (0.8, 1.0), (0.8, 0.4), (0.6, -0.7), (0.8, 0.0)]
    bundles.expect_drives(submission, cases)

"""The longer comparisons of the hidden graders of ``digital-twin``."""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

bundles = kit.companion("digital-twin", "bundles")
actuators, sensors = bundles.actuators, bundles.sensors
rays = kit.sibling(__file__, "rays")


def expect_randomness(submission, rng):
    """Noise and bias are independent, and the generator that is passed in decides about both."""
    n, dt, seed = 4000, rng.uniform(0.004, 0.05), int(rng.integers(2**32))
    calls = [(np.zeros(n), dt, 0.01, 0.01, 0.0, np.random.default_rng(s)) for s in (seed, seed, seed + 1)]
    first, again, other = bundles.imu_pairs(submission, calls)
    repeats = np.array_equal(first, again) and not np.array_equal(first, other)
    kit.expect_true(
        bool(repeats),
        "The generator that is passed in does not decide about the noise.",
        help="Draw from rng and from nothing else.",
        diagnose=lambda: sensors.of_randomness(submission),
    )
    with np.errstate(all="ignore"):
        white, steps = first[0] - first[1], np.diff(first[1])
        pairs = ((white[:-1], steps), (white[1:], steps), (white[:-1], white[1:]), (steps[:-1], steps[1:]))
        alike = [abs(float(np.corrcoef(a, b)[0, 1])) for a, b in pairs]
    kit.expect_bounded(
        max(alike) if np.all(np.isfinite(alike)) else math.nan,
        high=0.1,
        source="six times the scatter of a correlation from 4000 samples",
        quantity="largest correlation",
        input={"dt": dt, "noise_density": 0.01, "bias_random_walk": 0.01, "samples": n},
        message="White noise and steps of the bias are not independent of each other and of their own past.",
        help="Draw two arrays of standard normal numbers, and sum up only one of them.",
        diagnose=lambda: sensors.of_imu(submission),
    )


def expect_scan_noise(submission, rng):
    """Hits have noise of their own, never below zero, and other readings have none."""
    r_max, sigma = rng.uniform(6.0, 9.0), rng.uniform(0.02, 0.08)
    wall = np.array([[[3.0, -30.0], [3.0, 30.0]]])
    fan = np.linspace(-2.0, 2.0, 4000)
    calls = [(np.array([x, 0.0, 0.0]), wall, fan, r_max, sigma, rng) for x in (0.0, 3.0 - 0.5 * sigma)]
    far, near = (kit.as_vector(v, 4000, "ranges") for v in submission.call_each("lidar", calls))
    expected, _ = rays.distances(calls[0][0], wall, fan, r_max)
    misses = expected == r_max
    given = {"r_max": r_max, "sigma": sigma, "beams": 4000}
    ask = lambda: sensors.of_lidar_noise(submission) or sensors.of_lidar(submission)  # noqa: E731
    kit.expect_true(
        bool(np.all(far[misses] == r_max)),
        "A beam that hits nothing does not read r_max exactly.",
        help="Noise belongs to hits only.",
        input=given,
        diagnose=ask,
    )
    noise = (far - expected)[~misses]
    kit.expect_close(
        bundles.std(noise),
        sigma,
        rel=0.1,
        source="five times the scatter of a std from the hits of one scan, 2000 or more",
        quantity="std of the noise",
        units="m",
        input=given,
        message="The noise of the hits does not have the std sigma.",
        help="Add sigma times a standard normal number of its own to each hit.",
        diagnose=ask,
    )
    ahead = near[np.abs(fan) < 0.5]  # half a std from the wall, nearly: three in ten readings fall below zero
    kit.expect_true(
        bool(np.all(ahead >= 0.0) and np.mean(ahead == 0.0) > 0.2),
        "Very close to a wall, the noise is not cut off at zero.",
        help="No distance is below zero: np.maximum(..., 0.0) after the noise.",
        input=given,
        diagnose=ask,
    )


def expect_hall(submission, rng):
    """Every beam finds its nearest wall or none."""
    walls, r_max = rays.hall(rng), rng.uniform(2.5, 3.5)
    poses = np.column_stack((rng.uniform(-1.5, 1.5, (5, 2)), rng.uniform(-6, 6, 5)))
    angles = np.sort(rng.uniform(-3.1, 3.1, 40))
    calls = [(pose, walls, angles, r_max, 0.0, rng) for pose in poses]
    for pose, value in zip(poses, submission.call_each("lidar", calls), strict=True):
        expected, clear = rays.distances(pose, walls, angles, r_max)
        ranges = kit.as_vector(value, len(angles), "ranges")
        kit.expect_array(
            ranges[clear],
            expected[clear],
            abs=1e-9,
            source="rounding",
            quantity="ranges",
            units="m",
            input={"pose": pose, "segments": walls, "r_max": r_max, "sigma": 0.0},
            message="In an unknown hall, without noise, a distance is wrong.",
            help="Try a wall behind the robot, one that the beam misses, two in a row, and none.",
            diagnose=lambda: sensors.of_lidar(submission),
        )


def expect_slow_turns(submission, rng):
    """As the turn rate goes to zero, the arc goes over into a straight line."""
    # One in each decade of the slow ones: whatever is taken for straight, one just below it is asked for.
    decades = np.arange(-11, -1) + rng.uniform(0, 1, 10)
    rates = [0.0, 0.0, *(10.0 ** rng.uniform(-14, -11, 8)), *(10.0**decades)]
    track = rng.uniform(0.3, 0.8)
    calls = []
    for rate in rates:
        v, half = rng.uniform(0.2, 0.9), rng.choice([-1, 1]) * rate * track / 2
        calls.append((rng.uniform(-2, 2, 3), v - half, v + half, track, rng.uniform(0.5, 2.0)))
    for call, value in zip(calls, submission.call_each("diff_drive_step", calls), strict=True):
        pose, (v_left, v_right, _, dt) = call[0], call[1:]
        turn = (v_right - v_left) / track * dt
        way = (v_left + v_right) / 2 * dt * (1 - turn**2 / 24 + turn**4 / 1920)
        middle = pose[2] + turn / 2
        end = pose + np.array([way * math.cos(middle), way * math.sin(middle), turn])
        bundles.expect_pose(
            submission,
            value,
            pose,
            call[1:],
            end,
            abs_=1e-5,
            source="cancelling sines lose up to 1e-6 m at the best thresholds, 1e-4 m and more without one",
        )


def expect_swings(submission, rng):
    """On swings of any speed the output is late by half the gap each way."""
    gap = rng.uniform(0.2, 1.0)
    inputs, states, outputs = [], [], []
    for count, size in ((40, 3.0), (11, 3.0), (20, 0.4)):  # slow, fast, and within the play
        x = size * gap * np.sin(np.linspace(0, rng.uniform(8, 12), count)) + rng.normal()
        y = float(x[0]) + rng.uniform(-0.4, 0.4) * gap
        for value in x:
            states.append(y)
            y = float(np.clip(y, value - gap / 2, value + gap / 2))
            outputs.append(y)
        inputs += x.tolist()
    bundles.expect_play(submission, inputs, gap, states, outputs)


def expect_motor(submission, w, calls):
    """A motor goes through these commands as theory says."""
    found = submission.fold("motor_step", w, calls)[1:]
    expected = []
    for u, dt, tau, u_max, dead in calls:
        goal = float(np.clip(u, -u_max, u_max)) * (abs(u) > dead)
        w = goal + (w - goal) * math.exp(-dt / tau)
        expected.append(w)
    kit.expect_array(
        [kit.as_number(value, "w_next") for value in found],
        expected,
        abs=1e-9,
        source="rounding",
        quantity="w",
        units="rad/s",
        t=np.cumsum([dt for _, dt, *_ in calls]),
        input={"(u, dt, tau, u_max, deadband)": calls},
        message="The speed of an unknown motor is not what its command, limits and lag make of it.",
        help="In this order: dead band, saturation, then the exact lag from wherever the speed is.",
        diagnose=lambda: actuators.of_motor(submission),
    )


def delayed(x, dt, latency):
    """Sample by sample: the two around each moment, weighted by how near they are."""
    y = np.zeros(len(x))
    whole, part = divmod(latency / dt + 1e-9, 1.0)  # 1e-9 of a sample is rounding
    part = max(part - 1e-9, 0.0)
    for k in range(len(x)):
        i = k - int(whole)
        if i > 0 or (i == 0 and part < 1e-8):
            y[k] = (1 - part) * x[i] + (part * x[i - 1] if part else 0.0)
    return y

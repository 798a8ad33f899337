"""The comparisons of the hidden graders of ``digital-twin`` whose right values are found in another way."""

from __future__ import annotations

import numpy as np

from course.scoring import kit

actuators = kit.companion("digital-twin", "actuator_bundles")
bundles = kit.companion("digital-twin", "bundles")
scanners = kit.companion("digital-twin", "lidar_probes")
rays = kit.sibling(__file__, "rays")


def expect_ranges(submission, value, pose, walls, angles, r_max, message):
    """Every beam that is no close call reads the distance to its nearest wall, or r_max."""
    expected, clear = rays.distances(pose, walls, angles, r_max)
    kit.expect_array(
        kit.as_vector(value, len(angles), "ranges")[clear],
        expected[clear],
        abs=1e-9,
        source="rounding",
        quantity="ranges",
        units="m",
        input={"pose": pose, "segments": walls, "angles": angles, "r_max": r_max, "sigma": 0.0},
        message=message,
        help="Take the beam of this index alone. For each wall, print the distance along the beam and the "
        "place between the ends of the wall: is it a hit? Then take the smallest of all hits.",
        diagnose=lambda: scanners.of_lidar(submission, noisy=False),
    )


def expect_hall(submission, rng):
    """Every beam finds its nearest wall or none, in a hall and where a long wall is before a short one."""
    walls, r_max = rays.hall(rng), rng.uniform(2.5, 3.5)
    poses = np.column_stack((rng.uniform(-1.5, 1.5, (5, 2)), rng.uniform(-6, 6, 5)))
    angles = np.sort(rng.uniform(-3.1, 3.1, 40))
    calls = [(pose, walls, angles, r_max, 0.0, rng) for pose in poses]
    # One beam goes through the middle of both walls, and either may come last.
    walls = rays.long_before_short(poses[0], rng)
    x, y = np.mean(walls[1], axis=0) - poses[0][:2]
    beams = np.append(angles, np.angle(np.exp(1j * (np.arctan2(y, x) - poses[0][2]))))
    calls += [(poses[0], pair, beams, r_max, 0.0, rng) for pair in (walls, walls[::-1])]
    others = poses[1], rays.hall(rng), rng.uniform(-3.1, 3.1, 40), 0.8 * r_max
    calls += [(*call, 0.0, rng) for call in bundles.one_by_one(calls[0][:4], others)]
    # A wall of a metre, square to a beam: the cross product of their directions is 1, or -1.
    x, ends = rng.uniform(0.5, 2.0), rng.permutation([-0.5, 0.5])
    calls.append((np.zeros(3), np.array([[[x, y] for y in ends]]), np.array([0.0]), 3, 0.0, rng))  # an int
    message = "In an unknown hall, without noise, a distance is wrong."
    for call, value in zip(calls, submission.call_each("lidar", calls), strict=True):
        expect_ranges(submission, value, *call[:4], message)


def expect_tour(submission, rng):
    """Thirty arcs one after the other; each step is compared with the arc from where the one before ended.

    Twenty turn one way, many times round, and the last ten the other way.
    """
    track = rng.uniform(0.2, 0.8)
    rates = rng.choice([-1, 1]) * np.repeat([1.0, -1.0], [20, 10]) * rng.uniform(0.2, 1.5, 30)
    speeds, dts = rng.uniform(-0.8, 0.8, 30), rng.uniform(0.1, 2.0, 30)
    calls = [
        (float(v - rate * track / 2), float(v + rate * track / 2), track, float(dt))
        for v, rate, dt in zip(speeds, rates, dts, strict=True)
    ]
    pose = rng.uniform(-3, 3, 3)
    for value, wheels in zip(submission.fold("diff_drive_step", pose, calls)[1:], calls, strict=True):
        actuators.expect_pose(submission, value, pose, wheels)
        pose = kit.as_vector(value, 3, "the pose")


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
    for part in (1e-3, 1e-5, 1e-6):  # and so slow that each step moves the output by next to nothing
        for side in (1.0, -1.0):
            states.append(side * gap)
            outputs.append(side * (1 + part) * gap)
            inputs.append(outputs[-1] + side * gap / 2)
    actuators.expect_play(submission, inputs, gap, states, outputs)
    calls = bundles.one_by_one((2.0, gap, 0.0), (3.0, 0.5 * gap, 2.1))
    inputs, gaps, states = map(list, zip(*calls, strict=True))
    outputs = [float(np.clip(y, x - play / 2, x + play / 2)) for x, play, y in calls]
    actuators.expect_play(submission, inputs, gaps, states, outputs)


def expect_delays(submission, cases):
    """Each signal (x, dt, latency) comes out that much later."""
    for case, value in zip(cases, submission.call_each("delay_line", cases), strict=True):
        actuators.expect_delayed(submission, value, *case, delayed(*case))


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

"""A drive round the room for the report of ``digital-twin``, and what the sensors showed on it.

A robot on two wheels drives a figure of eight. Its pose is kept in three ways: the true one, the one that
its encoders give, and a heading summed up from its gyroscope.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.scoring import kit

scenes = kit.companion("digital-twin", "scenes")

_DT, _N = 0.05, 480
_TRACK, _RADIUS, _COUNTS = 0.4, 0.08, 64
_START = (1.5, 2.0, 0.0)
_GRIP = np.array([1.0, 0.99])  # the right wheel slips a little, and no encoder sees it
_BEAMS = np.linspace(-2.0, 2.0, 81)
_REACH, _SIGMA = 3.5, 0.02
_DENSITY, _WALK, _BIAS = 0.002, 0.001, 0.01


@functools.cache
def _truth():
    """Wheel speeds (N, 2), m/s, and true poses (N + 1, 3): an eight, drawn a little askew by slip."""
    rate = np.where(np.arange(_N) < _N // 2, 1.0, -1.0) * 2 * math.pi / (_DT * _N / 2)
    speeds = 0.45 + rate[:, None] * _TRACK / 2 * np.array([-1.0, 1.0])
    poses = [np.array(_START)]
    for left, right in speeds * _GRIP:
        turn, way = (right - left) / _TRACK * _DT, (left + right) / 2 * _DT
        x, y, heading = poses[-1]
        middle, chord = heading + turn / 2, way * float(np.sinc(turn / (2 * math.pi)))
        poses.append(np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn]))
    return speeds, np.array(poses)


def _odometry(submission):
    """Poses (N + 1, 3) from the student's encoder and diff_drive_step, and the wheel speeds behind them."""
    speeds, _ = _truth()
    angles = np.vstack((np.zeros(2), np.cumsum(speeds * _DT / _RADIUS, axis=0)))
    values = submission.call_each("encoder", [(wheel, _COUNTS) for wheel in angles.T])
    counts = np.column_stack([kit.as_vector(value, _N + 1, "counts") for value in values])
    seen = np.diff(counts, axis=0) * 2 * math.pi / _COUNTS * _RADIUS / _DT
    calls = [(float(left), float(right), _TRACK, _DT) for left, right in seen]
    poses = [kit.as_vector(p, 3, "pose") for p in submission.fold("diff_drive_step", np.array(_START), calls)]
    return np.array(poses), seen


def _gyroscope(submission):
    """The turn rate that the student's imu shows, shape (N,)."""
    rates = np.diff(_truth()[1][:, 2]) / _DT
    value = submission.call("imu", rates, _DT, _DENSITY, _WALK, _BIAS, np.random.default_rng(11))
    return kit.as_vector(kit.as_tuple(value, ("measured", "bias"))[0], _N, "measured")


def _scans(submission):
    """One scan of the room a second, (times, ranges)."""
    picks = np.arange(0, _N, round(1 / _DT))
    calls = [
        (_truth()[1][i], scenes.ROOM, _BEAMS, _REACH, _SIGMA, np.random.default_rng(100 + int(i)))
        for i in picks
    ]
    ranges = [kit.as_vector(v, len(_BEAMS), "ranges") for v in submission.call_each("lidar", calls)]
    return _DT * picks, np.array(ranges)


def section(submission):
    """The three paths and headings."""
    (_, true), (poses, _), rates = _truth(), _odometry(submission), _gyroscope(submission)
    t = _DT * np.arange(_N + 1)
    heading = np.append(0.0, np.cumsum(rates) * _DT) - true[:, 2]
    lost = float(np.hypot(*(poses[-1] - true[-1])[:2]))
    walls = [kit.Series("walls" if i == 0 else "", *wall.T, quiet=True) for i, wall in enumerate(scenes.ROOM)]
    map_ = kit.Panel(
        "x / m",
        "y / m",
        (
            *walls,
            kit.Series("true", true[:, 0], true[:, 1]),
            kit.Series("by its encoders", poses[:, 0], poses[:, 1]),
        ),
        equal=True,
    )
    turned = kit.Panel(
        "time / s",
        "heading off by / rad",
        (
            kit.Series("encoders", t, poses[:, 2] - true[:, 2]),
            kit.Series("gyroscope, summed up", t, heading),
        ),
    )
    return kit.Section(
        "A drive round the room",
        text="An eight of 24 s. The right wheel slips by one part in a hundred, which no encoder sees; the "
        "gyroscope sees it and has a bias of its own. Neither is corrected by anything: this is what "
        "synchronising is for.",
        columns=("at the end", "off by"),
        rows=(
            ("position by encoders", f"{100 * lost:.0f} cm"),
            ("heading by encoders", f"{poses[-1, 2] - true[-1, 2]:+.2f} rad"),
            ("heading by gyroscope", f"{heading[-1]:+.2f} rad"),
        ),
        plot=kit.Plot(
            "Dead reckoning drifts, each sensor in its own way",
            (map_, turned),
            f"Upper panel: the true path and the one by encoders, {100 * lost:.0f} cm apart at the end. "
            "Lower panel: errors of the heading by encoders and by gyroscope, both growing.",
        ),
    )


def streams(submission):
    """What the sensors showed, as plain streams for a ROS 2 bag; those whose functions are written."""
    found = {}
    rates = kit.attempt(lambda: _gyroscope(submission))
    scans = kit.attempt(lambda: _scans(submission))
    odometry = kit.attempt(lambda: _odometry(submission))
    t = _DT * np.arange(_N + 1)
    if rates is not None:
        found["imu"] = {"t": t[1:], "angular_velocity_z": rates, "variance": _DENSITY**2 / _DT}
    if scans is not None:
        found["scan"] = {
            "t": scans[0],
            "ranges": scans[1],
            "angle_min": float(_BEAMS[0]),
            "angle_increment": float(_BEAMS[1] - _BEAMS[0]),
            "range_max": _REACH,
        }
    if odometry is not None:
        found["odometry"] = _moves(t, *odometry)
    if found:
        speeds, poses = _truth()
        found["truth"] = _moves(t, poses, speeds * _GRIP)
    return found


def _moves(t, poses, wheels):
    """Poses (N + 1, 3) with the speed of the step that led to each; the first has that of the next."""
    wheels = np.vstack((wheels[:1], wheels))
    return {
        "t": t,
        "x": poses[:, 0],
        "y": poses[:, 1],
        "heading": poses[:, 2],
        "speed": wheels.mean(axis=1),
        "turn_rate": (wheels[:, 1] - wheels[:, 0]) / _TRACK,
    }

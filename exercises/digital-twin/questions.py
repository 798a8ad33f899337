"""Calls that tell wrong programs of ``digital-twin`` apart; a task with a failed check is asked them besides.

The same at home and in a grading run. What they should give is not here.
"""

from __future__ import annotations

import math

import numpy as np

# -- sensors --------------------------------------------------------------------------------------------


def _angles():
    """Both signs, within one turn and over many, in fine counts and in coarse ones."""
    for per_turn, most in ((64, 400), (7, 60), (360, 900)):
        counts = np.linspace(-most, most, 23) + np.linspace(0.07, 0.41, 23) + 0.5 * (np.arange(23) % 2)
        yield counts * 2 * math.pi / per_turn, per_turn


def _rates():
    """One kind of noise at a time, both, and none, at two sampling rates."""
    true = np.linspace(0.5, -0.3, 7)
    for i, (dt, density, walk, first) in enumerate(
        ((0.04, 0.0, 0.0, 0.3), (0.04, 0.02, 0.0, -0.2), (0.25, 0.0, 0.05, 0.4), (0.01, 0.03, 0.2, 0.0))
    ):
        yield true, dt, density, walk, first, np.random.default_rng(900 + i)


#: A crooked room without a door: whichever way a beam goes, it hits, and each way another distance off.
_CORNERS = np.array([[-2.0, -1.5], [3.0, -1.0], [2.5, 2.0], [-1.5, 1.2]])
_ROOM = np.stack((_CORNERS, np.roll(_CORNERS, -1, axis=0)), axis=1)
_AHEAD = np.array([[[2.0, -1.0], [2.0, 1.0]]])


def _shifted(x):
    """The wall ahead, x further off."""
    return _AHEAD + np.array([x, 0.0])


_ROW = np.concatenate([_shifted(x) for x in (0.0, -1.0, 1.5)])


def _scans():
    """A room from inside, walls ahead, behind, in a row and out of reach; then noise on hits and on none."""
    fan = np.linspace(-2.9, 2.7, 15)
    nowhere, here = np.zeros(3), np.array([0.4, 0.3, 0.7])
    scenes = (
        (here, _ROOM, fan),
        (np.array([0.4, 0.3, -2.2]), _ROOM, fan),
        (nowhere, _AHEAD, np.array([0.3, 1.0, -1.0, 3.0])),
        (nowhere, _ROW, np.array([0.1, -0.2])),
        (nowhere, _shifted(4.0), np.array([0.01])),
        (nowhere, _AHEAD[:, ::-1], np.array([0.3])),
    )
    for pose, walls, beams in scenes:
        yield pose, walls, beams, 5.0, 0.0, np.random.default_rng(1)
    yield here, _ROOM, fan, 4, 0.0, np.random.default_rng(1)  # a whole number
    # Every beam hits, or none does: in which order the numbers are drawn makes no difference.
    noisy = ((0.0, 5.0, 0.1), (1.97, 5.0, 0.2), (-2.96, 5.0, 0.3))
    for i, (x, reach, sigma) in enumerate(noisy):
        yield (
            np.array([x, 0.0, 0.0]),
            _AHEAD,
            np.linspace(-0.01, 0.01, 12),
            reach,
            sigma,
            np.random.default_rng(910 + i),
        )
    yield nowhere, _AHEAD, np.array([2.0, 2.2, -2.5]), 5.0, 0.1, np.random.default_rng(920)


# -- actuators and odometry -----------------------------------------------------------------------------


def _commands():
    """Usual, too large, swallowed, at the edge, from beyond u_max; then short and long steps."""
    usual, large, swallowed = (6.0, -6.0), (14.0, -14.0), (1.5, -1.5, 2.0, 0.7, 1.9)
    for w, u in (*((1.0, u) for u in usual + large), *((4.0, u) for u in swallowed), (30.0, 5.0)):
        yield w, u, 0.3, 0.5, 10.0, 2.0
    for dt, tau in ((0.02, 0.7), (1.9, 0.3)):
        yield -2.0, 7.0, dt, tau, 8.0, 0.5
    yield 1.0, 6.0, 0.3, 0.5, 4.0, 5.0  # u_max lies within the dead band


def _plays():
    """Inside the play, beyond either side, near zero, far off, exactly at the edge; and in a narrow gear."""
    places = (
        (0.3, 0.1),
        (0.9, 0.0),
        (-0.9, 0.0),
        (0.2, 1.4),
        (0.2, -1.4),
        (5.0, 4.8),
        (5.0, 1.0),
        (-2.0, -2.4),
        (1.5, 1.0),
    )
    for x, state in places:
        yield x, 1.0, state
    for x, gap, state in (
        (1.1, 0.3, 0.9),
        (1.1, 0.3, 2.0),
        (-3.0, 3.0, 4.0),
        (-10.0, 2.0, 0.0),
        (8.0, 5.0, -1.0),
    ):
        yield x, gap, state


def _signals():
    """Less than a sample of latency, several and a part, whole ones, none, and more than there is."""
    x = np.array([2.0, 3.0, 1.0, 5.0, 4.0, 4.0, -1.0, 2.5, 0.5])
    for dt, latency in ((0.1, 0.225), (0.1, 0.03), (0.25, 1.0), (0.2, 0.37), (0.1, 0.0), (0.1, 1.7)):
        yield x, dt, latency
    yield np.array([2, 3, 1, 5]), 0.1, 0.25


def _drives():
    """Numbers of no pattern: with right = 3 left, the sum of both would be twice their difference."""
    pose = np.array([1.0, 2.0, 2.5])
    for left, right, track, dt in ((0.31, 0.83, 0.47, 1.3), (-0.2, -0.55, 0.6, 0.7), (0.4, 0.4, 0.5, 2.0)):
        yield pose, left, right, track, dt
    yield np.array([-1.0, 0.5, 3.0]), -0.3, 0.42, 0.35, 0.9
    yield np.array([0.2, -0.6, -0.4]), 0.3, 0.25, 0.4, 0.5
    yield np.zeros(3), 0.5, 0.5 + 4e-3, 0.5, 1.0
    yield np.array([0.3, 0.2, 1.0]), -0.4, 0.4, 0.5, 0.7


# -- the twin -------------------------------------------------------------------------------------------


def _twin(friction, drive, speed, position=0.0, t=0.0):
    return {
        "t": t,
        "position": position,
        "speed": speed,
        "friction": friction,
        "drive": drive,
        "sigma": 0.02,
        "memory": {},
    }


def _measurements():
    """A cart ahead and behind, forwards and backwards, after long and short; and one that is not new."""
    forwards, backwards = _twin(0.5, 0.7, 1.2, 0.4, 3.0), _twin(0.8, -0.5, -0.9, -1.0, 2.0)
    for z, at in ((0.53, 3.1), (0.49, 3.1), (0.61, 3.15), (0.3, 2.8)):
        yield forwards, z, at
    for z, at in ((-1.08, 2.1), (-1.12, 2.1), (-1.03, 2.05)):
        yield backwards, z, at


def _targets():
    for friction, drive, speed, target in (
        (0.8, 0.3, 1.5, 1.5),
        (0.8, 0.3, -0.75, -0.75),
        (0.4, 0.3, 1.5, 1.5),
        (0.8, 0.5, 0.6, 0.6),
        (1.7, -0.2, 0.0, 0.0),
        (1.7, 0.1, 0.9, 0.9),
        (0.6, 0.4, 0.7, 1.3),
        (1.1, 0.4, -0.2, -1.1),
    ):
        yield _twin(friction, drive, speed), target


QUESTIONS = {
    "encoder": list(_angles()),
    "imu": list(_rates()),
    "fit_noise": [],  # right answers scatter: the probes compare them with the recordings
    "lidar": list(_scans()),
    "motor_step": list(_commands()),
    "backlash": list(_plays()),
    "delay_line": list(_signals()),
    "diff_drive_step": list(_drives()),
    "sync": list(_measurements()),
    "command": list(_targets()),
}


def _state(twin):
    """What a twin says; how it remembers is its own affair."""
    return [twin[key] for key in ("t", "position", "speed", "friction", "drive", "sigma")]


#: What counts of an answer where not all of it does.
READ = {"sync": _state}

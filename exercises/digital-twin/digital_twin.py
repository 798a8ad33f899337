"""A digital twin of a mobile robot: its sensors, its actuators, and the traffic in both directions.

SI units and radians throughout. Replace each ``raise`` by your code; keep the names and the arguments.
Start with ``encoder`` or ``backlash``: two lines each. README.md has the formulae and an example of each.
"""

import math  # noqa: F401 - yours to use

import numpy as np  # noqa: F401 - yours to use

# -- sensors --------------------------------------------------------------------------------------------


def encoder(theta, counts_per_rev):
    """What a counter on a shaft shows.

    theta: angle of the shaft at each reading, rad, shape (N,); runs over many turns, both ways
    counts_per_rev: counts of one turn
    Returns whole numbers (int64), shape (N,): theta * counts_per_rev / (2 pi), rounded down or to nearest.
    """
    raise NotImplementedError


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    """What a gyroscope shows of a turn rate: white noise on a bias that wanders.

    true: turn rate, rad/s, shape (N,)
    dt: time between samples, s
    noise_density: N of the white noise, rad/s/sqrt(Hz)
    bias_random_walk: K of the bias, rad/s/sqrt(s)
    bias0: bias of the first sample, rad/s
    rng: numpy Generator; the only source of randomness
    Returns (measured, bias), both rad/s, shape (N,).
    """
    raise NotImplementedError


def fit_noise(still, dt):
    """The numbers of ``imu`` from what a gyroscope showed while it lay still.

    still: turn rate shown, rad/s, shape (N,); the true one is 0 throughout
    dt: time between samples, s
    Returns {"noise_density": ..., "bias_random_walk": ..., "bias0": ...}, floats.
    """
    raise NotImplementedError


def lidar(pose, segments, angles, r_max, sigma, rng):
    """Distances that a laser scanner measures to walls.

    pose: x, y (m) and heading (rad), shape (3,)
    segments: two end points of each wall, m, shape (M, 2, 2)
    angles: direction of each beam, relative to the heading, rad, shape (B,)
    r_max: reach, m
    sigma: std of the noise of a hit, m
    rng: numpy Generator
    Returns shape (B,), m: nearest hit + noise, never below 0; exactly r_max where nothing is hit within it.
    """
    raise NotImplementedError


# -- actuators ------------------------------------------------------------------------------------------


def motor_step(w, u, dt, tau, u_max, deadband):
    """Speed of a motor dt later, under one constant command.

    w: speed now, rad/s; may lie beyond u_max
    u: commanded speed, rad/s
    dt: s, of any size
    tau: time constant of the lag, s
    u_max: largest command that counts, rad/s
    deadband: commands up to this size do nothing, rad/s
    Returns w_next, a float.
    """
    raise NotImplementedError


def backlash(x, gap, state):
    """Output of a gear train with play.

    x: input position now
    gap: total play, in the unit of x
    state: what the call before returned as state_next (the output until now)
    Returns (y, state_next): the output, and what to give the next call.
    """
    raise NotImplementedError


def delay_line(x, dt, latency):
    """A signal as it arrives later.

    x: samples at times 0, dt, 2 dt, ..., shape (N,)
    dt: s
    latency: s, no multiple of dt in general; 0 or more
    Returns shape (N,): at time k dt, what x was at k dt - latency: on the straight line between two
    samples, 0.0 before the first.
    """
    raise NotImplementedError


# -- odometry -------------------------------------------------------------------------------------------


def diff_drive_step(pose, v_left, v_right, track, dt):
    """Pose of a robot with two driven wheels after dt at constant wheel speeds.

    pose: x, y (m) and heading (rad, counter-clockwise from x), shape (3,)
    v_left, v_right: speeds at which the wheels roll, m/s
    track: distance between the wheels, m
    dt: s
    Returns the new pose, shape (3,): on the exact arc, heading not wrapped.
    """
    raise NotImplementedError


# -- the twin -------------------------------------------------------------------------------------------


def sync(twin, z, t_measured):
    """Robot to twin: take one measured position in.

    twin: {"t": s, "position": m, "speed": m/s, "friction": 1/s, "drive": m/s², "sigma": m, "memory": {}}
    z: measured position, m, with a noise of std twin["sigma"]
    t_measured: when it was measured, s; usually after twin["t"], sometimes before it
    Returns a new dict of the same keys, predicted to max(twin["t"], t_measured). ``memory`` is yours:
    whatever plain data you want back at the next call.
    """
    raise NotImplementedError
    # A way to begin, in this order; each line helps a little, and the checks say what is still missing.
    #   1. Predict: the state dt = t_measured - twin["t"] later, with dv/dt = drive - friction * v.
    #   2. Surprise: z - predicted position.
    #   3. Correct position and speed by a share of the surprise, friction by a small one (its sign!).
    #   4. A measurement that is late (dt < 0): leave it out at first, and fit it into the past when all
    #      else works.
    #   5. Better shares: those of a Kalman filter, whose 3 by 3 covariance lives in ``memory``.


def command(twin, target_speed):
    """Twin to robot: the drive that holds a speed under the twin's friction.

    twin: as in ``sync``
    target_speed: m/s, either sign
    Returns the drive, m/s², a float.
    """
    raise NotImplementedError

"""A digital twin of a mobile robot: its sensors, its actuators, and the exchange in both directions.

SI units and radians throughout. Replace each ``raise`` with your code; keep the names and the arguments.
Start with ``encoder``, then ``backlash``: two lines each. README.md has the formulae, with examples.
"""

import math  # noqa: F401 - yours to use

import numpy as np  # noqa: F401 - yours to use

# -- sensors --------------------------------------------------------------------------------------------


def encoder(theta, counts_per_rev):
    """Readings of a counter on a shaft.

    theta: angle of the shaft at each reading, rad, shape (N,); runs over many turns in both directions
    counts_per_rev: counts of one turn
    Returns whole numbers (int64), shape (N,): theta * counts_per_rev / (2 pi), rounded down or to nearest.
    """
    raise NotImplementedError


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    """Readings of a gyroscope: the turn rate, a bias that drifts, and white noise.

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
    """The parameters of ``imu``, from a recording of a gyroscope that lay still.

    still: recorded turn rate, rad/s, shape (N,); the true rate is 0 throughout
    dt: time between samples, s
    Returns {"noise_density": ..., "bias_random_walk": ..., "bias0": ...}, floats.
    """
    raise NotImplementedError


def lidar(pose, segments, angles, r_max, sigma, rng):
    """Distances to walls that a laser scanner measures.

    pose: x, y (m) and heading (rad), shape (3,)
    segments: two end points of each wall, m, shape (M, 2, 2)
    angles: direction of each beam, relative to the heading, rad, shape (B,)
    r_max: range of the scanner, m
    sigma: std of the noise of a hit, m
    rng: numpy Generator
    Returns shape (B,), m: nearest hit + noise, never below 0; exactly r_max if there is no hit within it.
    """
    raise NotImplementedError


# -- actuators ------------------------------------------------------------------------------------------


def motor_step(w, u, dt, tau, u_max, deadband):
    """Speed of a motor dt later, under one constant command.

    w: speed now, rad/s; may lie beyond u_max
    u: commanded speed, rad/s
    dt: s, of any size
    tau: time constant of the lag, s
    u_max: largest speed the motor can be commanded to, rad/s
    deadband: commands up to this size do nothing, rad/s
    Returns w_next, a float.
    """
    raise NotImplementedError


def backlash(x, gap, state):
    """Output of a gear train with backlash.

    x: input position now
    gap: total backlash, in the unit of x
    state: state_next of the call before (the output until now)
    Returns (y, state_next): the output, and the state for the next call.
    """
    raise NotImplementedError


def delay_line(x, dt, latency):
    """A signal that arrives later.

    x: samples at times 0, dt, 2 dt, ..., shape (N,)
    dt: s
    latency: s, not a multiple of dt in general; 0 or more
    Returns shape (N,): at time k dt the value of x at k dt - latency, on the straight line between two
    samples, and 0.0 before the first.
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
    """From robot to twin: use one measured position.

    twin: {"t": s, "position": m, "speed": m/s, "friction": 1/s, "drive": m/s², "sigma": m, "memory": {}}
    z: measured position, m, with a noise of std twin["sigma"]
    t_measured: when it was measured, s; usually after twin["t"], sometimes before it
    Returns a new dict with the same keys, predicted to max(twin["t"], t_measured). ``memory`` is yours:
    any plain data that you need at the next call.
    """
    raise NotImplementedError
    # A way to start, in this order; each line helps a little, and the checks say what is still missing.
    #   1. Predict: the state dt = t_measured - twin["t"] later, with dv/dt = drive - friction * v.
    #   2. Surprise: z - predicted position.
    #   3. Correct position and speed by a share of the surprise, friction by a small share (mind the sign).
    #   4. A measurement that is late (dt < 0): ignore it at first. When everything else works, use it at
    #      its own time in the past.
    #   5. Better shares: those of a Kalman filter, with its 3 by 3 covariance in ``memory``.


def command(twin, target_speed):
    """From twin to robot: the drive that holds a speed under the twin's friction.

    twin: as in ``sync``
    target_speed: m/s, either sign
    Returns the drive, m/s², a float.
    """
    raise NotImplementedError

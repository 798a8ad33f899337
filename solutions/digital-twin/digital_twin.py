"""Sensors, actuators and synchronisation of a digital twin. SI units throughout."""

import math

import numpy as np

# -- sensors --------------------------------------------------------------------------------------------


def encoder(theta, counts_per_rev):
    """Whole counts of an angle (rad) over many turns."""
    return np.floor(np.asarray(theta) * counts_per_rev / (2 * math.pi)).astype(np.int64)


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    """A rate gyroscope: white noise, whose std grows as 1/sqrt(dt), on a bias that walks as sqrt(time)."""
    n = len(true)
    steps = bias_random_walk * math.sqrt(dt) * rng.standard_normal(n - 1)
    bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias


def fit_noise(still, dt):
    """The three numbers of ``imu`` from a recording at rest, by Allan's variance.

    The variance between neighbouring means over a time T is 2 (N²/T + K² T/3): the noise fades with T, the
    walk grows with it, and the line through both against T gives the two of them.
    """
    still = np.asarray(still, dtype=float)
    sizes = np.unique(np.geomspace(1, len(still) // 12, 30).astype(int))
    times = sizes * dt
    total = np.concatenate(([0.0], np.cumsum(still)))
    allan, weight = np.empty(len(sizes)), np.empty(len(sizes))
    for i, size in enumerate(sizes):
        means = (total[size:] - total[:-size]) / size
        allan[i] = np.mean((means[size:] - means[:-size]) ** 2) / 2
        weight[i] = len(still) / size
    basis = np.stack((1 / times, times * (1 + 1 / (2 * sizes**2)) / 3), axis=1)  # sampled, not continuous
    relative = np.sqrt(weight) / allan
    for _ in range(6):  # weigh by what the model expects, not by the scatter itself
        squares = np.maximum(np.linalg.lstsq(basis * relative[:, None], allan * relative)[0], 1e-30)
        relative = np.sqrt(weight) / (basis @ squares)
    density, walk = map(float, np.sqrt(squares))
    window = max(1, min(len(still), round(math.sqrt(3) * density / (walk * dt))))
    return {
        "noise_density": density,
        "bias_random_walk": walk,
        "bias0": float(
            np.mean(still[:window])
        ),  # longer, and the walk spoils it; shorter, and the noise does
    }


def lidar(pose, segments, angles, r_max, sigma, rng):
    """Distance along each beam to the nearest of some walls; r_max where there is none."""
    x, y, heading = pose
    segments = np.asarray(segments, dtype=float).reshape(-1, 2, 2)
    beam = heading + np.asarray(angles, dtype=float)[:, None]
    dx, dy = np.cos(beam), np.sin(beam)
    ax, ay = (segments[:, 0] - (x, y)).T
    wx, wy = (segments[:, 1] - segments[:, 0]).T
    cross = dx * wy - dy * wx  # zero where beam and wall are parallel
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (ax * wy - ay * wx) / cross
        share = (ax * dy - ay * dx) / cross
    hit = (cross != 0) & (along >= 0) & (share >= 0) & (share <= 1) & (along <= r_max)
    nearest = np.min(np.where(hit, along, np.inf), axis=1, initial=np.inf)
    noisy = np.maximum(nearest + sigma * rng.standard_normal(len(beam)), 0.0)
    return np.where(np.isfinite(nearest), noisy, r_max)


# -- actuators ------------------------------------------------------------------------------------------


def motor_step(w, u, dt, tau, u_max, deadband):
    """Speed of a motor a step later: dead band, then saturation, then a lag solved exactly."""
    u = 0.0 if abs(u) <= deadband else min(max(u, -u_max), u_max)
    return w - math.expm1(-dt / tau) * (u - w)


def backlash(x, gap, state):
    """Output of a gear with play: it rests until the input has crossed the gap."""
    y = min(max(state, x - gap / 2), x + gap / 2)
    return y, y


def delay_line(x, dt, latency):
    """A signal as it arrives ``latency`` later; 0 before its first sample has arrived."""
    t = dt * np.arange(len(x))
    return np.interp(t - latency, t, x, left=0.0)


# -- odometry -------------------------------------------------------------------------------------------


def diff_drive_step(pose, v_left, v_right, track, dt):
    """Pose after dt on the arc that two constant wheel speeds make."""
    x, y, heading = pose
    turn = (v_right - v_left) / track * dt
    chord = (v_left + v_right) / 2 * dt * np.sinc(turn / (2 * math.pi))  # sin(turn/2)/(turn/2), 1 at 0
    middle = heading + turn / 2
    return np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn])


# -- the twin -------------------------------------------------------------------------------------------

_SPREAD = np.diag([0.05, 0.3, 0.3]) ** 2  # of position, speed and friction at the start: m, m/s, 1/s
_WANDER = np.diag([0.0, 0.005, 0.06]) ** 2  # what a second adds to it
_KEEP = 2.0  # s of history, to fit late measurements in


def _predict(state, spread, drive, dt):
    """Carry position, speed and friction on, and how far off they may be."""
    x, v, b = state
    fade = math.exp(-b * dt)
    reach = -math.expm1(-b * dt) / b if abs(b) > 1e-9 else dt
    v_next = v * fade + drive * reach
    x_next = x + v * reach + drive * (dt * dt / 2 if abs(b) <= 1e-9 else (dt - reach) / b)
    slope = np.array([[1.0, reach, -v * dt * dt / 2], [0.0, fade, -(v + v_next) / 2 * dt], [0.0, 0.0, 1.0]])
    return np.array([x_next, v_next, b]), slope @ spread @ slope.T + _WANDER * dt


def _correct(state, spread, z, sigma):
    """Kalman's correction by a measured position."""
    gain = spread[:, 0] / (spread[0, 0] + sigma * sigma)
    return state + gain * (z - state[0]), spread - np.outer(gain, spread[0])


def sync(twin, z, t_measured):
    """The twin after a measured position: an extended Kalman filter that replays when one comes late.

    The memory is one row a measurement: t, z, drive from then on, state after it, spread after it.
    """
    now = np.array([twin["position"], twin["speed"], twin["friction"]])
    first = np.concatenate(([twin["t"], math.nan, twin["drive"]], now, _SPREAD.ravel()))
    rows = [np.array(row) for row in twin["memory"].get("rows", [first])]
    rows[-1][2] = twin["drive"]  # the caller may have changed it
    later = [row for row in rows if row[0] > t_measured]
    rows = rows[: len(rows) - len(later)]
    if rows:
        queue = [(t_measured, z, rows[-1][2])] + [tuple(row[:3]) for row in later]
        for t, seen, drive in queue:
            last = rows[-1]
            state, spread = _predict(last[3:6], last[6:].reshape(3, 3), last[2], t - last[0])
            state, spread = _correct(state, spread, seen, twin["sigma"])
            rows.append(np.concatenate(([t, seen, drive], state, spread.ravel())))
    else:
        rows = later  # older than the history: too late to be of use
    t, _, _, x, v, b = map(float, rows[-1][:6])
    rows = [row for row in rows if row[0] >= t - _KEEP]
    return {**twin, "t": t, "position": x, "speed": v, "friction": b, "memory": {"rows": np.array(rows)}}


def command(twin, target_speed):
    """The drive (m/s²) at which friction just eats up the gain, at that speed."""
    return twin["friction"] * target_speed

"""From simulation to reality: a plan that is carried out on carts whose parameters you do not know.

The given functions come first: the cart as a simulation, and the parts of a fit. The four functions at the
end are yours. README.md has the cart, the words a plan may use, and a worked example.
"""

import math

import numpy as np

H = 0.01  # s, the step of the controller, of rollout and of every recording
NAMES = ("m", "b", "Fc", "tau", "latency")
NOISE_SPEED = 0.01  # m/s, standard deviation of the measured speed

# -- given: the cart ------------------------------------------------------------------------------------


def rollout(kp, kd, cart, rng):
    """Settling times of a step to 1 m, for every cart and every pair of gains, s.

    kp, kd: gains in N/m and N s/m, shape (G,), or two numbers
    cart: {"m", "b", "Fc", "tau", "latency"}, each of shape (D,), or numbers
    rng: where the position sensor's noise comes from; all gains see the same noise
    Returns shape (D, G). 3.0 means: not settled when the run ends, or more than 0.10 m past the mark.
    """
    kp, kd = np.atleast_1d(kp), np.atleast_1d(kd)
    m, b, Fc, tau, latency = (np.atleast_1d(cart[k]).astype(float)[:, None] for k in NAMES)
    carts, n = len(m), 300
    late = np.rint(latency[:, 0] / H).astype(int)
    longest, row = late.max() + 1, np.arange(carts)
    noise = 0.002 * rng.standard_normal((n, carts, 1))
    follow, smooth = 1 - np.exp(-H / tau), 1 - math.exp(-H / 0.02)
    kick, drag, rub = H / m, 1 / (1 + H * b / m), H * Fc / m
    sent = np.zeros((longest, carts, len(kp)))  # the last commands, one on the way for each step of latency
    x, v, f, vf, y_before, top, last = (np.zeros((carts, len(kp))) for _ in range(7))
    for i in range(n):
        y = x + noise[i]
        vf += smooth * ((y - y_before) / H - vf)
        y_before = y
        sent[i % longest] = np.minimum(np.maximum(kp * (1 - y) - kd * vf, -8.0), 8.0)
        f += follow * (sent[(i - late) % longest, row] - f)
        v = drag * (v + kick * f)
        v -= np.minimum(np.maximum(v, -rub), rub)  # Coulomb friction stops, it never reverses
        x = x + H * v
        np.maximum(top, x, out=top)
        np.copyto(last, i + 1, where=~(np.abs(x - 1) <= 0.05))  # written so that NaN counts as off
    return np.where(top > 1.10, 3.0, H * last)


def record(cart, u, rng):
    """A bench run from rest: (t, y), each of shape (N,), for a command u of shape (N,).

    u[k] is commanded, in N, from t[k] to t[k+1]; y is the measured speed in m/s, with noise of 0.01 m/s.
    """
    h, sub = H / 5, 5
    u = np.clip(np.asarray(u, dtype=float), -3.0, 3.0)  # the bench's amplifier gives no more
    t = H * np.arange(len(u) + 1)
    fine = h * np.arange(sub * len(u) + 1)
    pushed = np.interp(fine - cart["latency"], t, np.concatenate([[0.0], np.cumsum(u) * H]))
    heard = (np.diff(pushed) / h).tolist()
    keep = math.exp(-h / cart["tau"])
    mean_of_lag = cart["tau"] * (1 - keep) / h
    kick, drag, rub = h / cart["m"], 1 / (1 + h * cart["b"] / cart["m"]), h * cart["Fc"] / cart["m"]
    v = f = 0.0
    speed = []
    for i, command in enumerate(heard):
        if i % sub == 0:
            speed.append(v)
        behind = f - command
        v = (v + kick * (command + behind * mean_of_lag)) * drag
        v = v - rub if v > rub else v + rub if v < -rub else 0.0
        f = command + behind * keep
    return t[:-1], np.array(speed) + NOISE_SPEED * rng.standard_normal(len(u))


# -- given: the parts of a fit --------------------------------------------------------------------------


def motor_impulse(u, tau):
    """Integral of the motor's force since the start, N s, (N,), if the command u (N,) arrived at once."""
    keep = math.exp(-H / tau)
    force = impulse = 0.0
    impulses = []
    for command in np.asarray(u, dtype=float).tolist():
        impulses.append(impulse)
        behind = force - command
        impulse += H * command + behind * tau * (1 - keep)
        force = command + behind * keep
    return np.array(impulses)


def delayed(x, latency):
    """x(t - latency) for samples x (N,) that start at zero; linear between samples."""
    t = H * np.arange(len(x))
    return np.interp(t - latency, t, x)


def cumulative(x):
    """Integral of the samples x (N,) since the start, by trapezoids, (N,)."""
    return H * np.concatenate([[0.0], np.cumsum((x[1:] + x[:-1]) / 2)])


def in_blocks(x, size=100):
    """Samples (N,) or (N, k) cut into blocks of ``size``, each minus its own mean: (blocks, size, k).

    An integral over a block starts from an unknown speed; without the mean this speed does not matter.
    Samples that do not fill a block are dropped.
    """
    count = len(x) // size
    blocks = np.reshape(x[: count * size], (count, size, -1))
    return blocks - blocks.mean(axis=1, keepdims=True)


# -- yours ----------------------------------------------------------------------------------------------


def plan():
    """The gaps between the simulation and the cart, and how to narrow each of them.

    Returns {"gaps", "excitation_budget_s", "randomization", "metric", "threshold"}:

    gaps: at least three dicts from at least three sources, each with
        "source", "parameter", "excitation", "estimator", "mitigation", "metric": words of the README's lists
        "threshold", "unit": the measurement works if the metric is at most this; "%" or "1"
    excitation_budget_s: seconds on the bench, at most 20
    randomization: {"m", "b", "Fc", "tau", "latency"}, each [low, high]: factors on the estimate
    metric: "success"; threshold: the success that the plan promises, 0.90 or more
    """
    raise NotImplementedError


def design_excitation(budget_s, u_max, rng):
    """Commands for the bench that show m, b, Fc and the lag.

    budget_s: duration, s
    u_max: N, the largest force in either direction
    rng: numpy Generator, if you want randomness
    Returns shape (round(100 * budget_s),), N: one command every 0.01 s, none larger than u_max.
    """
    raise NotImplementedError


def identify(t, u, y):
    """The cart's parameters from one bench recording, each with an honest 95 % interval.

    t: times, s, shape (N,), 0.01 s apart; the cart is at rest at t[0]
    u: commands, N, shape (N,)
    y: measured speed, m/s, shape (N,)
    Returns {"m", "b", "Fc", "tau", "latency", "lag"}, each [value, low, high]; lag = tau + latency.
    tau lies in 0.02 to 0.15 s, latency in 0.02 to 0.20 s.
    """
    raise NotImplementedError


def tune(estimate, randomization):
    """Gains with the least mean settling time over carts drawn around the estimate.

    estimate: {"m", "b", "Fc", "tau", "latency", "lag"}, each [value, low, high]
    randomization: {"m", "b", "Fc", "tau", "latency"}, each [low, high]: factors on the value
    Returns {"kp", "kd"}, N/m and N s/m.
    """
    raise NotImplementedError

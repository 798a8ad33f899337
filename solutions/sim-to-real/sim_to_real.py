"""From simulation to reality: a plan that is executed on carts whose parameters nobody tells you.

What is given comes first: the cart as a simulation, and the pieces that a fit is put together from. The four
functions at the end are yours. README.md has the cart, the words a plan may use, and a worked example.
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


# -- given: the pieces of a fit -------------------------------------------------------------------------


def motor_impulse(u, tau):
    """Integral of the motor's force since the start, N s, (N,), if it heard the command u (N,) at once."""
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
    """x(t - latency) for samples x (N,) that begin with zero; linear between samples."""
    t = H * np.arange(len(x))
    return np.interp(t - latency, t, x)


def cumulative(x):
    """Integral of the samples x (N,) since the start, by trapezoids, (N,)."""
    return H * np.concatenate([[0.0], np.cumsum((x[1:] + x[:-1]) / 2)])


def in_blocks(x, size=100):
    """Samples (N,) or (N, k) cut into blocks of ``size``, each less its own mean: (blocks, size, k).

    An integral over a block starts from an unknown speed; without its mean a block does not care which.
    Samples that do not fill a block are dropped.
    """
    count = len(x) // size
    blocks = np.reshape(x[: count * size], (count, size, -1))
    return blocks - blocks.mean(axis=1, keepdims=True)


# -- yours ----------------------------------------------------------------------------------------------

LOG_WIDTH = {"m": 0.35, "b": 0.50, "Fc": 0.30, "tau": 0.40, "latency": 0.40}


def plan():
    def gap(source, parameter, mitigation, threshold, excitation="prbs", estimator="integral_least_squares"):
        return {
            "source": source,
            "parameter": parameter,
            "excitation": excitation,
            "estimator": estimator,
            "mitigation": mitigation,
            "metric": "relative_half_width",
            "threshold": threshold,
            "unit": "%",
        }

    return {
        "gaps": [
            gap("environment", "m", "domain_randomization", 3.0),
            gap("friction", "b", "system_identification", 10.0),
            gap("friction", "Fc", "system_identification", 10.0),
            gap("actuator_lag", "lag", "system_identification", 10.0, estimator="delay_grid"),
            gap("sensor_noise", "noise", "noise_model", 5.0, "rest", "standard_deviation"),
        ],
        "excitation_budget_s": 20.0,
        "randomization": {k: [math.exp(-w), math.exp(w)] for k, w in LOG_WIDTH.items()},
        "metric": "success",
        "threshold": 0.94,
    }


def design_excitation(budget_s, u_max, rng):
    """Full force one way or the other, held for a random 0.1 to 0.6 s."""
    n = round(100 * budget_s)
    holds = rng.integers(10, 60, n)
    return u_max * np.repeat(rng.choice([-1.0, 1.0], n), holds)[:n]


def identify(t, u, y):
    # m v = impulse - b * integral of v - Fc * integral of sign(v), so v is linear in 1/m, b/m and Fc/m once
    # lag and latency are known: a grid for these two, least squares for the rest.
    v = in_blocks(y).reshape(-1)
    friction = in_blocks(np.stack([cumulative(y), cumulative(np.sign(y))], axis=1)).reshape(-1, 2)
    Q, _ = np.linalg.qr(friction)
    rest = v - Q @ (Q.T @ v)  # what friction alone cannot explain
    best = (0.0, 0.0, 0.0)
    for tau in np.arange(0.02, 0.151, 0.02):
        impulse = motor_impulse(u, tau)
        trials = np.stack([delayed(impulse, late) for late in np.arange(0.02, 0.201, 0.01)], axis=1)
        trials = in_blocks(trials).reshape(len(v), -1)
        trials -= Q @ (Q.T @ trials)
        explained = (rest @ trials) ** 2 / np.sum(trials**2, axis=0)
        k = int(explained.argmax())
        best = max(best, (float(explained[k]), float(tau), 0.02 + 0.01 * k))
    _, tau, late = best

    # Newton's method from there: two more columns say how the impulse changes with tau and latency.
    d = 0.001
    for _ in range(3):
        impulse = motor_impulse(u, tau)
        by_tau = (motor_impulse(u, tau + d) - motor_impulse(u, tau - d)) / (2 * d)
        by_late = (delayed(impulse, late + d) - delayed(impulse, late - d)) / (2 * d)
        columns = [
            delayed(impulse, late),
            cumulative(y),
            cumulative(np.sign(y)),
            delayed(by_tau, late),
            by_late,
        ]
        X = in_blocks(np.stack(columns, axis=1))
        XX = X.transpose(0, 2, 1) @ X  # one 5 x 5 matrix and one vector per block
        Xv = (X.transpose(0, 2, 1) @ in_blocks(y))[..., 0]
        start = tau, late
        theta = np.linalg.solve(XX.sum(axis=0), Xv.sum(axis=0))
        value = _parameters(theta, *start)
        tau, late = np.clip(value[3:5], [0.005, 0.0], [0.2, 0.3])

    # Jackknife: leave out one block after the other. Noise in y is also in its integrals, so the residuals
    # of one block hang together, and the usual formula, which counts each sample, would be overconfident.
    left_out = np.linalg.solve(XX.sum(axis=0) - XX, (Xv.sum(axis=0) - Xv)[..., None])[..., 0]
    each = _parameters(left_out, *start)
    n = len(each)
    half = 2.1 * np.sqrt((n - 1) / n * np.sum((each - each.mean(axis=0)) ** 2, axis=0))
    names = (*NAMES, "lag")
    return {name: [float(x), float(x - w), float(x + w)] for name, x, w in zip(names, value, half)}


def _parameters(theta, tau, late):
    """m, b, Fc, tau, latency and lag from the coefficients of a fit around (tau, late)."""
    m = 1 / theta[..., 0]
    tau, late = tau + theta[..., 3] * m, late + theta[..., 4] * m
    return np.stack([m, -theta[..., 1] * m, -theta[..., 2] * m, tau, late, tau + late], axis=-1)


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    carts = {}
    for name in NAMES:
        low, high = np.log(randomization[name])
        share = (rng.permutation(200) + 0.5) / 200  # spread evenly, in an order of its own
        carts[name] = estimate[name][0] * np.exp(low + share * (high - low))
    few = {name: values[:60] for name, values in carts.items()}

    def best_of(carts, kp, ratio):
        kp, ratio = (x.ravel() for x in np.meshgrid(kp, ratio))
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
        return kp[mean.argmin()], ratio[mean.argmin()]

    # Coarsely on a few carts, then finely about the best on all. kd/kp decides the damping, so search that.
    kp, ratio = best_of(few, np.geomspace(2, 40, 12), np.linspace(0.25, 0.7, 8))
    kp, ratio = best_of(carts, kp * np.geomspace(0.8, 1.25, 5), ratio + np.linspace(-0.06, 0.06, 5))
    return {"kp": float(kp), "kd": float(kp * ratio)}

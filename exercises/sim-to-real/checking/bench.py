"""What a run on the bench can tell: the excitations that a plan may name, and the README's fit.

``cart.attainable`` says what the best of all estimators could read from a command. The fit that the README
gives is not the best, and it is what a recording is made for: it is judged too.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.scoring import kit

cart = kit.companion("sim-to-real", "cart")
H, NAMES = cart.H, cart.NAMES

# -- excitations by their word --------------------------------------------------------------------------


def excitation(word, seconds, rng):
    """The command (N,), N, that a word of the plan stands for."""
    n = max(2, round(seconds / H))
    t, top = H * np.arange(n), 3.0  # Hz, where the chirp ends
    commands = {
        "rest": lambda: np.zeros(n),
        "constant": lambda: np.full(n, cart.U_BENCH),
        "slow_sine": lambda: cart.U_BENCH * np.sin(2 * np.pi * 0.05 * t),
        "chirp": lambda: cart.U_BENCH * np.sin(2 * np.pi * (0.1 * t + (top - 0.1) * t**2 / (2 * t[-1]))),
        "multisine": lambda: _multisine(t, rng),
        "prbs": lambda: cart.prbs(n, cart.U_BENCH, rng),
    }
    return commands[word]()


def _multisine(t, rng):
    tones = np.arange(0.1, 2.45, 0.1)
    phases = rng.uniform(0, 2 * np.pi, len(tones))
    waves = np.sin(2 * np.pi * np.outer(t, tones) + phases) / np.sqrt(tones)
    total = waves.sum(axis=1)
    return cart.U_BENCH * total / np.abs(total).max()


def reach(word, parameter, seconds, carts, seed):
    """The narrowest 95 % half-width, as a share, that any estimator could have: worst of the carts.

    seed: of whatever is random in the excitation; numbers
    """
    if parameter == "noise":
        # A standard deviation from n samples of noise alone is known to 1/sqrt(2n); moving, it is not seen.
        return 1.96 / math.sqrt(2 * seconds / H) if word == "rest" else math.inf
    frozen = tuple(tuple(each[k] for k in NAMES) for each in carts)
    return _reach(word, round(seconds, 2), frozen, tuple(seed))[(*NAMES, "lag").index(parameter)]


@functools.lru_cache(maxsize=256)
def _reach(word, seconds, carts, seed):
    command = excitation(word, seconds, np.random.default_rng(seed))
    return cart.attainable(command, [dict(zip(NAMES, each, strict=True)) for each in carts]).max(axis=0)


# -- the README's fit -----------------------------------------------------------------------------------

_DRAWS = 6  # of the noise: the rms of so many errors scatters by 30 %


class _Silence:
    """Stands for a generator where a recording is to be without noise."""

    standard_normal = staticmethod(np.zeros)


def fit_errors(u, truth):
    """rms errors of the README's fit on recordings of this cart, as shares of m, b, Fc and the lag, (4,).

    Whole seconds of the integrated equation, tau and latency by their slopes about the right ones: a search
    that ends at the right pair of times ends with this fit, and no search ends better.
    """
    command = np.ascontiguousarray(u, dtype=float).tobytes()
    return _fit_errors(command, tuple(truth[k] for k in NAMES))


@functools.lru_cache(maxsize=64)  # many submissions of a run command the same
def _fit_errors(command, values):
    u, truth = np.frombuffer(command), dict(zip(NAMES, values, strict=True))
    d, tau, late = 0.001, truth["tau"], truth["latency"]
    impulse, later, sooner = (_impulse(u, each) for each in (tau, tau + d, tau - d))
    by_tau = _delayed((later - sooner) / (2 * d), late)
    by_late = (_delayed(impulse, late + d) - _delayed(impulse, late - d)) / (2 * d)
    fixed = _delayed(impulse, late), by_tau, by_late
    _, speed = cart.record(truth, u, _Silence())
    rng, lag = np.random.default_rng(41), tau + late
    known = np.array([truth["m"], truth["b"], truth["Fc"], lag])
    off = []
    for _ in range(_DRAWS):
        y = speed + cart.NOISE_SPEED * rng.standard_normal(len(u))
        columns = np.stack([fixed[0], _integral(y), _integral(np.sign(y)), *fixed[1:]], axis=1)
        theta = np.linalg.lstsq(_blocks(columns), _blocks(y[:, None])[:, 0])[0]
        m = 1 / theta[0]
        found = np.array([m, -theta[1] * m, -theta[2] * m, lag + (theta[3] + theta[4]) * m])
        off.append(found / known - 1)
    return np.sqrt(np.mean(np.square(off), axis=0))


def differentiated(u, y, truth):
    """The masses that come of differentiating the measured speed: by central and by one-sided differences.

    The motor's force is explained by acceleration, speed and its sign; noise in the acceleration makes the
    mass too small.
    """
    force = np.gradient(_delayed(_impulse(u, truth["tau"]), truth["latency"]), H)
    masses = []
    for a in (np.gradient(y, H), np.diff(y, append=y[-1]) / H):
        X = np.stack([a, y, np.sign(y)], axis=1)
        masses.append(float(np.linalg.lstsq(X, force)[0][0]))
    return masses


# -- fits with a mistake, and intervals from them ---------------------------------------------------------


def fits(u, y, tau, late):
    """m, b and Fc of a fit with these times, {what is wrong with it: (3,)}; "" is the README's own.

    A parameter whose column is missing is zero.
    """
    impulse = _delayed(_impulse(u, tau), late)
    force, sign = np.gradient(impulse, H), np.sign(y)
    viscous, coulomb, pushed = _integral(y), _integral(sign), _integral(np.sign(u))
    target = _blocks(y[:, None])[:, 0]
    found = {
        name: _fitted(_blocks(np.stack([impulse, *friction], axis=1)), target)
        for name, friction in (
            ("", (viscous, coulomb)),
            ("SIGN_OF_COMMAND", (viscous, pushed)),
            ("SIGN_OF_COMMAND late", (viscous, _delayed(pushed, late))),
            ("SIGN_OF_COMMAND force", (viscous, _integral(np.sign(force)))),
            ("SIGN_OF_POSITION", (viscous, np.sign(viscous))),
            ("SIGN_NOT_INTEGRATED", (viscous, sign)),
            ("FRICTION_DELAYED", (_delayed(viscous, late), _delayed(coulomb, late))),
            *(
                ("SIGN_WITH_DEAD_BAND" + name, (viscous, _integral(sign * (np.abs(y) > least))))
                for name, least in (("", 0.1), (" small", 0.05), (" large", 0.2))
            ),
        )
    }
    for name, column, at in (("COULOMB_AS_VISCOUS", viscous, 2), ("VISCOUS_AS_COULOMB", coulomb, 1)):
        found[name] = np.insert(_fitted(_blocks(np.stack([impulse, column], axis=1)), target), at, 0.0)
    whole, length = np.stack([impulse, viscous, coulomb], axis=1), round(1 / H)
    begun = np.arange(len(y)) // length * length
    found["BLOCKS_WITHOUT_CONSTANT"] = _fitted(whole, y)
    found["BLOCKS_WITHOUT_CONSTANT one"] = _fitted(whole - whole.mean(axis=0), y - y.mean())
    found["BLOCKS_WITHOUT_CONSTANT each"] = _fitted(whole - whole[begun], y)
    found["BLOCKS_FROM_FIRST"] = _fitted(whole - whole[begun], y - y[begun])
    columns = np.stack([force, y, sign], axis=1)
    for name, a in (("", np.gradient(y, H)), (" forwards", np.diff(y, append=y[-1]) / H)):
        found["ACCELERATION_FITTED" + name] = _fitted(columns, a)
    return found


def _fitted(columns, target):
    theta = np.linalg.lstsq(columns, target)[0]
    return np.array([1.0, *-theta[1:]]) / theta[0]


def fit(u, y, tau, late):
    """m, b and Fc of the README's fit with these times, (3,), and the sum of squares it leaves, (m/s)^2."""
    columns = _blocks(
        np.stack([_delayed(_impulse(u, tau), late), _integral(y), _integral(np.sign(y))], axis=1)
    )
    target = _blocks(y[:, None])[:, 0]
    theta = np.linalg.lstsq(columns, target)[0]
    return np.array([1.0, *-theta[1:]]) / theta[0], float(np.sum((target - columns @ theta) ** 2))


def errors(u, y, tau, late):
    """Standard errors of m, b, Fc, tau, latency and lag for a fit near these times, {how: (6,)}.

    "": the README's jackknife. "kept out": each refit also lacks the blocks that were left out before.
    "held": each refit has the times of all blocks. "formula": what the usual formula says of m, as a
    share, of blocks and of the whole recording, with the times fitted or known, (4,).
    """
    d, size = 0.001, round(1 / H)
    impulse, later, sooner = (_impulse(u, each) for each in (tau, tau + d, tau - d))
    by_tau = _delayed((later - sooner) / (2 * d), late)
    by_late = (_delayed(impulse, late + d) - _delayed(impulse, late - d)) / (2 * d)
    whole = np.stack([_delayed(impulse, late), _integral(y), _integral(np.sign(y)), by_tau, by_late], axis=1)
    cut, target = _blocks(whole), _blocks(y[:, None])[:, 0]
    X, v = cut.reshape(-1, size, 5), target.reshape(-1, size)
    XX, Xv = X.transpose(0, 2, 1) @ X, np.einsum("bki,bk->bi", X, v)
    others = XX.sum(axis=0) - XX, Xv.sum(axis=0) - Xv
    refits = {
        "": others,
        "kept out": ((XX.sum(axis=0) - XX.cumsum(axis=0))[:-1], (Xv.sum(axis=0) - Xv.cumsum(axis=0))[:-1]),
        "held": (others[0][:, :3, :3], others[1][:, :3]),
    }
    found = {}
    for name, (left, right) in refits.items():
        theta = (np.linalg.pinv(left) @ right[..., None])[..., 0]
        theta = np.pad(theta, [(0, 0), (0, 5 - theta.shape[1])])
        m = 1 / theta[:, 0]
        times = tau + theta[:, 3] * m, late + theta[:, 4] * m
        each = np.stack([m, -theta[:, 1] * m, -theta[:, 2] * m, *times, times[0] + times[1]], axis=1)
        n = len(each)
        found[name] = np.sqrt((n - 1) / n * np.sum((each - each.mean(axis=0)) ** 2, axis=0))
    found["formula"] = np.array(
        [_by_formula(A[:, :k], b) for A, b in ((cut, target), (whole, y)) for k in (3, 5)]
    )
    return found


def _by_formula(columns, target):
    """The usual standard error of m as a share of it, where the errors of all samples are independent."""
    theta = np.linalg.lstsq(columns, target)[0]
    left = np.sum((target - columns @ theta) ** 2) / (len(target) - columns.shape[1])
    return math.sqrt(left * np.linalg.pinv(columns.T @ columns)[0, 0]) / abs(theta[0])


def _impulse(u, tau):
    """Integral of the motor's force since the start, N s, (N,), if it heard the command at once."""
    keep = math.exp(-H / tau)
    force = impulse = 0.0
    impulses = []
    for command in u.tolist():
        impulses.append(impulse)
        behind = force - command
        impulse += H * command + behind * tau * (1 - keep)
        force = command + behind * keep
    return np.array(impulses)


def _delayed(x, latency):
    t = H * np.arange(len(x))
    return np.interp(t - latency, t, x)


def _integral(x):
    return H * np.concatenate([[0.0], np.cumsum((x[1:] + x[:-1]) / 2)])


def _blocks(x):
    """Rows of whole seconds, each second less its mean; what is left over is dropped."""
    size = round(1 / H)
    blocks = x[: len(x) // size * size].reshape(-1, size, x.shape[1])
    return (blocks - blocks.mean(axis=1, keepdims=True)).reshape(-1, x.shape[1])

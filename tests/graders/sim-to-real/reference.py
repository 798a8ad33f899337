"""Sound stand-ins for each part of a plan, and the realities it is executed on.

Everything that does not depend on the submission is computed once for a grading run and kept: it costs
about a second, and not once for every student.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.scoring import kit

bench = kit.companion("sim-to-real", "bench")
cart = kit.companion("sim-to-real", "cart")
NAMES = cart.NAMES

#: Three types of cart, as factors of the data sheet's values: light with a slow drive, ordinary, heavy with
#: a quick one. So far apart that no gains serve all three (tests/benchmarks/calibration/sim-to-real.md).
TYPES = (
    {"m": (0.60, 0.75), "tau": (1.1, 1.4), "latency": (1.1, 1.4)},
    {"m": (0.90, 1.10), "tau": (0.8, 1.25), "latency": (0.8, 1.25)},
    {"m": (1.35, 1.70), "tau": (0.7, 0.9), "latency": (0.7, 0.9)},
)
_DRAWS = 400


def realities(seed):
    """The three carts of a grading run; what they are no submission is told."""
    rng = np.random.default_rng([seed, 1])
    return tuple(
        {k: cart.SHEET[k] * math.exp(rng.uniform(*np.log(kind.get(k, (0.8, 1.25))))) for k in NAMES}
        for kind in TYPES
    )


# -- what gains achieve ---------------------------------------------------------------------------------

_KP, _RATIO = np.geomspace(2.0, 40.0, 14), np.linspace(0.2, 0.8, 11)


def _pairs(kp, ratio):
    kp, ratio = (grid.ravel() for grid in np.meshgrid(kp, ratio, indexing="ij"))
    return kp, kp * ratio


def search(carts, noise_seed, first, fine=7):
    """The gains with the least mean settling over ``carts``, and that mean: a coarse grid, then a fine one.

    Args:
        first: how many of the carts the coarse grid is tried on.
    """
    few = {k: carts[k][:first] for k in NAMES}
    kp, kd = _pairs(_KP, _RATIO)
    best = int(cart.rollout(kp, kd, few, np.random.default_rng(noise_seed)).mean(axis=0).argmin())
    ratio = kd[best] / kp[best]
    kp, kd = _pairs(kp[best] * np.geomspace(1 / 1.25, 1.25, fine), ratio + np.linspace(-0.06, 0.06, fine))
    mean = cart.rollout(kp, kd, carts, np.random.default_rng(noise_seed)).mean(axis=0)
    best = int(mean.argmin())
    return float(kp[best]), float(kd[best]), float(mean[best])


@functools.lru_cache(maxsize=64)  # of runs of three: the carts of a run are small
def held_out(seed, i):
    """Reality number i's fleet, unseen by anyone, and the least mean settling that any gains reach on it."""
    carts = cart.fleet(realities(seed)[i], _DRAWS, np.random.default_rng([seed, 2, i]))
    return carts, search(carts, [seed, 3, i], first=100)[2]


@functools.lru_cache(maxsize=1024)  # many submissions of a run come to the same gains
def success(seed, i, kp, kd):
    """min(1, best/own) of these gains on the held-out fleet of reality i."""
    carts, best = held_out(seed, i)
    own = float(cart.rollout(kp, kd, carts, np.random.default_rng([seed, 3, i])).mean())
    return min(1.0, best / own)


#: Which box ``tune`` is asked about beside the fleet's, for each reality.
OTHER_BOXES = (cart.LOADED, cart.PROMPT, cart.shifted_box(0.25))


@functools.lru_cache(maxsize=64)
def _other_fleet(seed, i):
    """Carts drawn from the other box about reality i, and the least mean settling that any gains reach."""
    carts = cart.drawn(realities(seed)[i], OTHER_BOXES[i], 300, np.random.default_rng([seed, 8, i]))
    return carts, search(carts, [seed, 9, i], first=100)[2]


@functools.lru_cache(maxsize=1024)
def other_success(seed, i, kp, kd):
    """min(1, best/own) of these gains on carts drawn from the other box about reality i."""
    carts, best = _other_fleet(seed, i)
    own = float(cart.rollout(kp, kd, carts, np.random.default_rng([seed, 9, i])).mean())
    return min(1.0, best / own)


# -- stand-ins ------------------------------------------------------------------------------------------


def tune(estimate, box, draws=400):
    """Sound gains (kp, kd) for an estimate {name: value} and a box {name: (low, high)} of factors."""
    rng = np.random.default_rng(4)
    share = (cart.stratified(draws, rng) + 1) / 2
    low = np.log([box[k][0] for k in NAMES])
    high = np.log([box[k][1] for k in NAMES])
    factors = np.exp(low + share * (high - low))
    carts = {k: estimate[k] * factors[:, j] for j, k in enumerate(NAMES)}
    return search(carts, 5, first=80)[:2]


@functools.lru_cache(maxsize=4)  # of runs: 300 kB each
def recordings(seed):
    """Two bench recordings of each reality, with random full force: six (t, u, y)."""
    carts, rng = [*realities(seed)] * 2, np.random.default_rng([seed, 4])
    return cart.prbs_recordings(carts, cart.BUDGET_S, cart.U_BENCH, rng)


@functools.lru_cache(maxsize=4)
def weak_recordings(seed):
    """One recording of 8 s at 1.2 N of each reality: three (t, u, y)."""
    rng = np.random.default_rng([seed, 10])
    return cart.prbs_recordings(realities(seed), *WEAK, rng)


#: Seconds and force (N) of a recording that tells little.
WEAK = (8.0, 1.2)


def box_success(seed, box):
    """Success over the three fleets with sound tuning for this box {name: (low, high)}.

    Boxes that differ by less than a hundredth are one: most submissions share it, and so its cost.
    """
    key = tuple(round(math.log(end), 2) for name in NAMES for end in box[name])
    return _box_success(seed, key)


@functools.lru_cache(maxsize=64)
def _box_success(seed, ends):
    factors = {k: (math.exp(ends[2 * i]), math.exp(ends[2 * i + 1])) for i, k in enumerate(NAMES)}
    return float(np.mean([success(seed, i, *tune(real, factors)) for i, real in enumerate(realities(seed))]))


def reach(seed, excitation, parameter, seconds):
    """The narrowest 95 % half-width, as a share, that any estimator could have: worst of the realities."""
    return bench.reach(excitation, parameter, seconds, realities(seed), (seed, 5))

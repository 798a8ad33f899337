"""What a right report of ``validate`` says about carts whose speeds are known at every time."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from course.scoring import kit

model = kit.sibling(__file__, "validation")
MEASURES = ("rmse", "bias", "lag_s", "coverage")


def facts(recorded, sim, real, lates, mass):
    """The facts as ``bundles.Facts`` has them, plain.

    Args:
        recorded: what was driven; ``lates``: how late the simulation of each is, s.
    """
    lags = _Lags(_curves(recorded, sim, lates, mass), float(np.max(np.abs(lates))))
    pairs = model.held_out_pairs(sim, real)
    alone = [_measure([pair], lags) for pair in pairs]
    several, n = len(pairs) > 1, np.arange(len(pairs))
    counts = [len(s["t"]) for s, _ in pairs]
    known = {
        "used": [s["id"] for s, _ in pairs],
        "numbers": _measure(pairs, lags) if pairs else None,
        "intervals": None,
        "steps": [float(s["t"][1] - s["t"][0]) for s, _ in pairs],
        "means": {key: float(np.mean([run[key] for run in alone])) for key in MEASURES} if several else {},
        "averages": [_average(alone, np.array(w)) for w in (n**0, counts)] if several else [],
        "alone": half([run["lag_s"] for run in alone]) if several else 0.0,
        "other_lags": {},
        "own": [run["lag_s"] for run in alone] if several else [],
    }
    if several:
        without = [_measure(pairs[:i] + pairs[i + 1 :], lags) for i in n]
        halves = {key: half([left[key] for left in without]) for key in MEASURES}
        known["intervals"] = {k: (v - halves[k], v + halves[k]) for k, v in known["numbers"].items()}
        known["other_lags"] = lambda: _other_lags(lags, known["used"])
    return known


def _measure(pairs, lags):
    e, sigma = together(pairs)
    numbers = {key: float(number(key, e, sigma)) for key in ("rmse", "bias", "coverage")}
    return numbers | {"lag_s": lags.of([s["id"] for s, _ in pairs])}


def together(pairs):
    """The errors of all samples of these pairs, and the sigmas."""
    y, sigma, measured = (np.concatenate(column) for column in zip(*map(model.columns, pairs), strict=True))
    return y - measured, sigma


def number(key, e, sigma):
    """rmse, bias or coverage."""
    if key == "coverage":
        return np.mean(np.abs(e) <= 1.96 * sigma)
    return np.sqrt(np.mean(e**2)) if key == "rmse" else np.mean(e)


def error(without):
    """The jackknife's standard error."""
    n, x = len(without), np.array(without)
    return math.sqrt((n - 1) / n * np.sum((x - x.mean()) ** 2))


def half(without):
    """Half the width of an interval."""
    return float(model.T95[len(without) - 2] * error(without))


def _other_lags(lags, ids):
    """Lags by other rules, each with half the width of the interval that it would have.

    A cost that jumps as samples come and go is looked at only as searches do: in steps of a run, in halves of
    them or in milliseconds.
    """
    grids, several = (min, max, lambda steps: max(steps) / 2, None), len(set(map(lags.step, ids))) > 1
    rules = {
        "even": [{"rule": "even"}],
        "sum": [{"rule": "sum", "grid": grid} for grid in grids],
        "product": [{"rule": rule, "grid": grid} for rule in ("product", "centred") for grid in grids],
        "outside": [{"rule": rule, "grid": grid} for rule in ("zero", "wrapped") for grid in grids],
        "shapes": [{"rule": "shapes"}],
        "alike": [{"grid": grid, "alike": True} for grid in (min, max, next)] if several else [],
    }
    return {name: [_lag_by(lags, ids, rule) for rule in some] for name, some in rules.items()}


def _lag_by(lags, ids, rule):
    """None where there is no lag by this rule."""
    found = [lags.of(some, **rule) for some in (ids, *(ids[:i] + ids[i + 1 :] for i in range(len(ids))))]
    return None if None in found else [found[0], half(found[1:])]


def _average(alone, weights):
    """A mean of the runs' own lags, and half the width of the interval that it would have."""
    n, lags = np.arange(len(alone)), np.array([run["lag_s"] for run in alone])
    without = [np.average(lags[n != i], weights=weights[n != i]) for i in n]
    return float(np.average(lags, weights=weights)), half(without)


def _curves(recorded, sim, lates, mass):
    """For each id, (t, y_real, speed): speed(times, shifts) is what the simulation says at each of the times
    later by each of the shifts, a row each."""
    starts = {run["id"]: run["y"][0] for run in sim["runs"]}
    known = {}
    for run, late in zip(recorded, np.broadcast_to(lates, len(recorded)), strict=True):
        clean = partial(_late, run.drive, late, mass)
        offset = starts[run.id] - float(clean(run.t[:1], np.zeros(1))[0, 0])
        known[run.id] = (run.t, run.y, partial(_raised, clean, offset))
    return known


def _late(drive, late, mass, t, shifts):
    return drive.moved(t, shifts - late, mass)


def _raised(clean, offset, t, shifts):
    return clean(t, shifts) + offset


#: Rules that ask what ``_Lags._others`` computes.
_BY_OTHERS = ("zero", "wrapped", "product", "centred", "shapes")


def _cost(rule, squares, counts, zero, wrapped, product, centred, level):
    """From the squares and the number of what overlaps, and from ``_Lags._others``."""
    costs = (squares + zero, squares + wrapped, -product, -centred, (squares - level) / counts)
    return costs[_BY_OTHERS.index(rule)]


class _Lags:
    """The best shift of any of the runs; ``reach``: the largest lag of any run, s."""

    STEP = 1e-3  # s; the cost is smooth on the scale of a tenth of a second

    def __init__(self, curves, reach):
        most = round(min(reach + 0.05, 0.2) / self.STEP)  # rules that are wrong find larger lags
        self._shifts = np.arange(-most, most + 1)
        self._curves, self._known = curves, {}

    def _parts(self, run_id, rule):
        """What this rule needs of a run."""
        parts = ()
        for of in (self._overlap, self._others)[: 1 + (rule in _BY_OTHERS)]:
            if (run_id, of.__name__) not in self._known:
                self._known[run_id, of.__name__] = of(*self._curves[run_id])
            parts += self._known[run_id, of.__name__]
        return parts

    def _inside(self, t):
        later = t + (self._shifts * self.STEP)[:, None]
        return (later >= t[0] - 1e-9) & (later <= t[-1] + 1e-9)

    def _overlap(self, t, y, speed):
        """For each shift, the sum of the squares, and the number, of the samples that overlap."""
        inside = self._inside(t)
        apart = (speed(t, self._shifts * self.STEP) - y) ** 2
        return np.sum(apart, axis=1, where=inside), inside.sum(axis=1)

    def _others(self, t, y, speed):
        """For each shift, the sum of the squares of the samples that do not overlap, with zeros and with the
        other end of the simulation, which np.roll brings there; and of those that do, sums of products, as
        they are and about the means, and the part of the squares that is their mean difference's."""
        inside, span = self._inside(t), len(t) * (t[1] - t[0])
        there = speed(t, self._shifts * self.STEP)
        turns = np.floor((t - t[0] + (self._shifts * self.STEP)[:, None] + 1e-9) / span)
        around = there
        for turn in np.unique(turns[turns != 0]):
            around = np.where(turns == turn, speed(t, self._shifts * self.STEP - turn * span), around)
        zero, wrapped = (np.sum((s - y) ** 2, axis=1, where=~inside) for s in (np.zeros_like(there), around))
        product, centred = (
            np.sum((there - a) * (y - b), axis=1, where=inside)
            for a, b in ((0.0, 0.0), (np.mean(speed(t, np.zeros(1))), np.mean(y)))
        )
        level = np.sum(there - y, axis=1, where=inside) ** 2 / inside.sum(axis=1)
        return zero, wrapped, product, centred, level

    def step(self, run_id):
        """The time between the samples of a run, s."""
        t = self._curves[run_id][0]
        return t[1] - t[0]

    def of(self, ids, rule="", grid=None, alike=False):
        """How late the simulation of these runs is, s: lowest point of the mean square of their samples.

        Args:
            rule: "even": of the mean of the runs' own mean squares; "sum": of the sum of the squares; "zero",
                "wrapped": of the mean square of all samples, with that in the place of the simulation where
                it has none; "product", "centred": of those sums, the highest; "shapes": of the mean square
                about each run's mean difference. Of any of them, a lowest point at an end is None.
            grid: what makes the step of the search of the runs' steps: min, max, next (the first) and so on;
                None for that of all shifts.
            alike: every run is moved by as many samples.
        """
        stride = round(grid(map(self.step, ids)) / self.STEP) if grid else 1
        most = len(self._shifts) // 2 // stride
        shifts = stride * np.arange(-most, most + 1)
        of_runs = np.array(
            [
                [
                    np.interp(
                        shifts * (self.step(i) / (stride * self.STEP) if alike else 1), self._shifts, part
                    )
                    for part in self._parts(i, rule)
                ]
                for i in ids
            ]
        )
        squares, counts, *others = of_runs.sum(axis=0)
        if rule in _BY_OTHERS:
            cost = _cost(rule, squares, counts, *others)
        elif rule == "even":
            cost = np.sum(of_runs[:, 0] / of_runs[:, 1], axis=0)
        else:
            cost = squares if rule == "sum" else squares / counts
        if rule and np.argmin(cost) in (0, len(cost) - 1):
            return None
        i = int(np.clip(np.argmin(cost), 1, len(cost) - 2))
        a, b, c = cost[i - 1 : i + 2]
        return float(self.STEP * (shifts[i] + stride * 0.5 * (a - c) / (a - 2 * b + c)))

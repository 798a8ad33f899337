"""Which mistake a wrong report of ``validate`` looks like, and the facts that it should have told.

A report is known by its numbers, by its intervals and by what it concludes from them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from course.grading import kit

named = kit.companion("validation", "diagnosis").named
match = kit.companion("validation", "probes").match

#: The measures of a report; the lag is compared by a search, the others to rounding.
MEASURES = ("rmse", "bias", "lag_s", "coverage")
NUMBERS = ("rmse", "bias", "coverage")

#: What Student's t of 1, 2, 3 ... degrees of freedom stays below with probability 0.95, and 0.975.
T95 = (6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812)
_T975 = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)


# -- the facts ------------------------------------------------------------------------------------------


def pairs_of(sim, real):
    """(simulated, real) of each run that counts."""
    known = {run["id"]: run for run in real["runs"]}
    return [
        (run, known[run["id"]])
        for run in sim["runs"]
        if run["id"] in known and run["id"] not in sim["calibrated_on"]
    ]


class Lags:
    """The best shift of any of the runs, from curves that are known at every time.

    Args:
        curves: for each id, (t, y_real, speed), where speed(times) is what the simulation says then.
        reach: the largest lag of any run, s.
    """

    STEP = 1e-3  # s; the cost is smooth on the scale of a tenth of a second

    def __init__(self, curves, reach):
        self._shifts = np.arange(-round((reach + 0.01) / self.STEP), round((reach + 0.01) / self.STEP) + 1)
        self._costs = {}
        shifts = self._shifts * self.STEP
        for run_id, (t, y, speed) in curves.items():
            later = t + shifts[:, None]
            inside = (later >= t[0] - 1e-9) & (later <= t[-1] + 1e-9)
            squares = np.where(inside, (speed(later) - y) ** 2, 0.0)
            self._costs[run_id] = squares.sum(axis=1), inside.sum(axis=1)

    def of(self, ids):
        """How late the simulation of these runs is, s: lowest point of the mean square of their samples."""
        cost = sum(self._costs[i][0] for i in ids) / sum(self._costs[i][1] for i in ids)
        i = int(np.clip(np.argmin(cost), 1, len(cost) - 2))
        a, b, c = cost[i - 1 : i + 2]
        return float(self.STEP * (self._shifts[i] + 0.5 * (a - c) / (a - 2 * b + c)))


@dataclass(frozen=True)
class Facts:
    """What a report should say.

    Attributes:
        used: the ids that count.
        numbers: rmse, bias, lag_s and coverage of all of them; None if there are none.
        without: the same with one run or another left out, one dict for each.
        single: the same of each run alone.
        steps: the times between samples, s, of each run.
        counts: how many samples each has.
        sampled: the standard errors that these numbers would have, were all samples independent.
    """

    used: list[str]
    numbers: dict[str, float] | None
    without: list[dict[str, float]]
    single: list[dict[str, float]]
    steps: list[float]
    counts: list[int]
    sampled: dict[str, float]

    @property
    def dt(self):
        """The longest time between samples, s."""
        return max(self.steps)

    def half(self, key):
        """Half the width of the interval: t times the jackknife's standard error."""
        n = len(self.used)
        values = np.array([left[key] for left in self.without])
        return float(T95[n - 2] * math.sqrt((n - 1) / n * np.sum((values - values.mean()) ** 2)))

    def interval(self, key):
        """(lo, hi) about the number."""
        return self.numbers[key] - self.half(key), self.numbers[key] + self.half(key)

    def reasons(self, spec):
        """What these limits refuse it for."""
        return judged({key: self.interval(key) for key in MEASURES}, spec)


def facts(sim, real, lags):
    """The facts about what is handed to ``validate``."""
    pairs = pairs_of(sim, real)
    measure = lambda some: {  # noqa: E731 - three uses
        **{key: float(pooled(key, some)) for key in NUMBERS},
        "lag_s": lags.of([s["id"] for s, _ in some]),
    }
    several = len(pairs) > 1
    return Facts(
        used=[s["id"] for s, _ in pairs],
        numbers=measure(pairs) if pairs else None,
        without=[measure(pairs[:i] + pairs[i + 1 :]) for i in range(len(pairs))] if several else [],
        single=[measure([pair]) for pair in pairs],
        steps=[float(s["t"][1] - s["t"][0]) for s, _ in pairs],
        counts=[len(s["t"]) for s, _ in pairs],
        sampled=_of_samples(pairs) if pairs else {},
    )


def pooled(key, pairs, reach=1.96):
    """rmse, bias or coverage of all samples of these pairs."""
    e = np.concatenate([s["y"] - r["y"] for s, r in pairs])
    sigma = np.concatenate([s["sigma"] for s, _ in pairs])
    if key == "coverage":
        return np.mean(np.abs(e) <= reach * sigma)
    return np.sqrt(np.mean(e**2)) if key == "rmse" else np.mean(e)


def _of_samples(pairs):
    e = np.concatenate([s["y"] - r["y"] for s, r in pairs])
    rmse, share, n = pooled("rmse", pairs), pooled("coverage", pairs), len(e)
    return {
        "rmse": float(np.std(e**2) / (2 * rmse) / math.sqrt(n)),
        "bias": float(np.std(e) / math.sqrt(n)),
        "coverage": math.sqrt(share * (1 - share) / n),
    }


def margins(spec):
    """(least, most) that each measure may be."""
    return {
        "rmse": (-math.inf, spec["rmse_max"]),
        "bias": (-spec["bias_max"], spec["bias_max"]),
        "lag_s": (-spec["lag_max_s"], spec["lag_max_s"]),
        "coverage": (spec["coverage_min"], spec["coverage_max"]),
    }


def judged(intervals, spec):
    """The sorted reasons against intervals (lo, hi), by measure."""
    allowed = margins(spec)
    return sorted(
        key.removesuffix("_s")
        for key, (lo, hi) in intervals.items()
        if not (allowed[key][0] <= lo and hi <= allowed[key][1])
    )


# -- which mistake --------------------------------------------------------------------------------------


def of_used(used, sim, real):
    """Why the wrong runs were used."""
    calibrated = set(sim["calibrated_on"])
    common = {run["id"] for run in sim["runs"]} & {run["id"] for run in real["runs"]}
    return named("CALIBRATION_RUNS_SCORED") if set(used) & calibrated & common else None


def of_number(key, value, sim, real):
    """What a wrong rmse, bias or coverage is."""
    known = {run["id"]: run for run in real["runs"]}
    common = [(run, known[run["id"]]) for run in sim["runs"] if run["id"] in known]
    fresh = pairs_of(sim, real)
    in_order = zip(sim["runs"], real["runs"], strict=False)
    placed = [(s, r) for s, r in in_order if len(s["y"]) == len(r["y"])]
    candidates = [("CALIBRATION_RUNS_SCORED", pooled(key, common))]
    candidates += [("MEAN_OF_RUNS", np.mean([pooled(key, [pair]) for pair in fresh]))]
    candidates += [(code, wrong) for code, wrong in _slips(key, fresh)]
    for pairs in (placed, [pair for pair in placed if pair[0]["id"] not in sim["calibrated_on"]]):
        if pairs:
            candidates.append(("MATCHED_BY_POSITION", pooled(key, pairs)))
    right = pooled(key, fresh)
    return match(value, [pair for pair in candidates if not np.isclose(pair[1], right, rtol=1e-6, atol=1e-9)])


def _slips(key, pairs):
    """(code, value) of the usual slips with the right runs."""
    e = np.concatenate([s["y"] - r["y"] for s, r in pairs])
    right = pooled(key, pairs)
    if key == "rmse":
        return [("ROOT_MISSING", np.mean(e**2)), ("MEAN_REMOVED", np.std(e)), ("BIAS_FOR_RMSE", np.mean(e))]
    if key == "bias":
        return [("WRONG_SIGN", -right), ("MEAN_ABSOLUTE", np.mean(np.abs(e)))]
    return [
        ("SIGMA_NOT_SCALED", pooled(key, pairs, 1.0)),
        ("IN_PER_CENT", 100 * right),
        ("OUTSIDE_COUNTED", 1 - right),
    ]


def of_lag(value, half, right):
    """What a wrong lag is, or that it is not the best.

    Args:
        half: half the width of the interval that was given for it; nan if there is none.
        right: the facts.
    """
    late, dt = right.numbers["lag_s"], right.dt
    near = lambda wrong: abs(value - wrong) <= 0.3 * dt  # noqa: E731 - a search is that good
    looks = [
        ("LAG_SIGN", abs(late) > 0.6 * dt and near(-late)),
        # A number of samples is recognised only where it cannot be anything else.
        ("LAG_IN_SAMPLES", abs(late) > dt and any(abs(value * h - late) <= 0.6 * h for h in right.steps)),
        ("LAG_AT_THE_END", abs(value) >= 0.19),  # no lag is larger than 0.2 s
        ("LAG_WHOLE_SAMPLES", abs(value - late) < 1.01 * dt and _whole(value, right)),
    ]
    looks.append(("LAG_MEAN_OF_RUNS", len(right.used) > 1 and _mean_of_runs(value, half, right)))
    return named(next((code for code, fits in looks if fits), "LAG_NOT_BEST"))


def _mean_of_runs(value, half, right):
    """Whether the lag and half the width of its interval are those of a mean of the runs' own lags."""
    n = len(right.used)
    alone = np.array([run["lag_s"] for run in right.single])
    for weights in (np.ones(n), np.array(right.counts, dtype=float)):
        mean = lambda some, weights=weights: np.average(alone[some], weights=weights[some])  # noqa: E731
        everything = np.arange(n)
        without = np.array([mean(everything[everything != i]) for i in range(n)])
        expected = T95[n - 2] * math.sqrt((n - 1) / n * np.sum((without - without.mean()) ** 2))
        if abs(value - mean(everything)) <= 0.06 * right.dt and abs(half - expected) <= 0.2 * right.dt:
            return True
    return False


def _whole(value, right):
    """Whether it is a whole number of samples."""
    return any(abs(value / step - round(value / step)) < 1e-6 for step in right.steps)


def of_lag_interval(value, right):
    """Why the interval of a lag is wrong, where the lag itself and the other intervals are right."""
    return named("LAG_WHOLE_SAMPLES" if _whole(value, right) else "LAG_OF_PARTS")


def of_intervals(ends, right):
    """What wrong intervals about a right rmse, bias and coverage are: one rule that gives all of them.

    Args:
        ends: (lo, hi) of each measure.
        right: the facts.
    """
    if all(ends[key][1] < ends[key][0] for key in NUMBERS if right.half(key) > 0):
        return named("RETURNS_SWAPPED")
    halves = {key: _halves(key, right) for key in NUMBERS}
    wrong = [key for key in NUMBERS if not _reaches(ends[key], right.numbers[key], right.half(key))]
    codes = {
        code
        for rule, (code, _) in enumerate(halves["bias"])
        if all(_reaches(ends[key], right.numbers[key], halves[key][rule][1]) for key in wrong)
    }
    return named(codes.pop()) if len(codes) == 1 else None


def _reaches(ends, value, half):
    """Whether an interval reaches so far to either side, to the digits of the table."""
    return max(abs(ends[0] - value + half), abs(ends[1] - value - half)) <= 2e-3 * half + 1e-9


def _halves(key, right):
    """(code, half the width) of the usual wrong rules, the same rules for every measure."""
    n = len(right.used)
    without = np.array([left[key] for left in right.without])
    spread = math.sqrt(np.sum((without - without.mean()) ** 2))
    alone = np.array([run[key] for run in right.single])
    t, error = T95[n - 2], math.sqrt((n - 1) / n) * spread
    return [
        *(("JACKKNIFE_FACTOR", t * spread / math.sqrt(by)) for by in (1, n, n - 1, n * n, n * (n - 1))),
        *(("NOT_STUDENTS_T", z * error) for z in (1.0, 1.645, 1.96, 2.0, 3.0)),
        *(("NOT_STUDENTS_T", table[n - 2] * error) for table in (T95[1:], (0.0, *T95), _T975)),
        ("SPREAD_OF_RUNS", t * np.std(alone, ddof=1) / math.sqrt(n)),
        ("SPREAD_OF_RUNS", t * np.std(alone, ddof=1)),
        ("SPREAD_OF_RUNS", t * np.std(alone)),
        ("ZERO_WIDTH", 0.0),
        *(("SAMPLES_COUNTED", z * right.sampled[key]) for z in (1.0, t, 1.645, 1.96, 2.0)),
    ]


def _outside(interval, margin):
    return not (margin[0] <= interval[0] and interval[1] <= margin[1])


def _beyond(interval, margin):
    return interval[1] < margin[0] or interval[0] > margin[1]


def _above(interval, margin):
    return interval[1] > margin[1]


def _concluded(right, spec, *, points=False, wrong=None):
    """The reasons that a slip leads to; ``wrong`` says by measure when an interval counts as wrong."""
    reasons = []
    for key, margin in margins(spec).items():
        value = right.numbers[key]
        interval = (value, value) if points or len(right.used) < 2 else right.interval(key)
        if (wrong or {}).get(key, _outside)(interval, margin):
            reasons.append(key.removesuffix("_s"))
    return sorted(reasons)


def _outside_above_zero(interval, margin):
    return interval[0] + interval[1] > 0 and _outside(interval, margin)


_NEVER = lambda interval, margin: False  # noqa: E731
_SIGNS = [
    dict.fromkeys(keys, wrong)
    for keys in (("bias",), ("lag_s",), ("bias", "lag_s"))
    for wrong in (_above, _outside_above_zero)
]
#: (code, what it changes) of slips in the conclusion.
_SLIPS = (
    ("POINT_ESTIMATE_JUDGED", {"points": True}),
    *(("SIGN_OF_LIMIT_IGNORED", {"wrong": wrong}) for wrong in _SIGNS),
    ("OVER_COVERAGE_ACCEPTED", {"wrong": {"coverage": lambda i, m: i[0] < m[0]}}),
    ("BURDEN_REVERSED", {"wrong": dict.fromkeys(MEASURES, _beyond)}),
    ("RMSE_ALONE_JUDGED", {"wrong": {"bias": _NEVER, "lag_s": _NEVER, "coverage": _NEVER}}),
)
#: Each of those with the number in place of its interval: looked at only where no single slip explains it.
_PAIRS = tuple((code, {**slip, "points": True}) for code, slip in _SLIPS if "wrong" in slip)


def of_verdicts(judged_cases):
    """What is wrong with reasons: the one slip that explains all of them, or what is missing.

    Args:
        judged_cases: (reasons, facts, spec) of each.
    """
    if all(sorted(reasons) == right.reasons(spec) for reasons, right, spec in judged_cases):
        return named("NOT_SORTED")
    fitting = _explaining(_SLIPS, judged_cases) or _explaining(_PAIRS, judged_cases)
    if len(fitting) == 1:
        return named(fitting.pop())
    missing = any(set(right.reasons(spec)) - set(reasons) for reasons, right, spec in judged_cases)
    return named("REASON_MISSING" if missing else "REASON_TOO_MANY")


def _explaining(slips, judged_cases):
    """The codes of slips that give all of these reasons."""
    return {
        code
        for code, slip in slips
        if all(sorted(reasons) == _concluded(right, spec, **slip) for reasons, right, spec in judged_cases)
    }

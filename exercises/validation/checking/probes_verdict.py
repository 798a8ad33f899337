"""Which mistake a wrong report of ``validate`` looks like, and the facts that it should have told.

What numbers, intervals and reasons follow from, the known mistakes tell; here is what a report shows by
itself, and the lag, which a search finds to a share of a sample.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from course.scoring import kit

if TYPE_CHECKING:
    from collections.abc import Callable

    OtherLags = dict[str, list[list[float] | None]]

named = kit.words("validation")

#: The measures of a report; the lag is compared by a search, the others to rounding.
MEASURES = ("rmse", "bias", "lag_s", "coverage")
NUMBERS = ("rmse", "bias", "coverage")


@dataclass(frozen=True)
class Facts:
    """What a report should say.

    Attributes:
        used: the ids that count.
        numbers: rmse, bias, lag_s and coverage of all of them; None if there are none.
        intervals: (lo, hi) of each; None if a single run or none counts.
        steps: the times between samples, s, of each run.
        means: of each measure, the mean of what it is in each run alone.
        averages: means of the runs' own lags, each with half the width that its interval would have.
        alone: half the width of the lag's interval, with each run alone in the place of all but one.
        other_lags: by other rules, the lags that they give, each with half the width that its interval would
            have; or what computes them, for only a wrong lag asks.
        own: the lags of the runs, each by itself.
    """

    used: list[str]
    numbers: dict[str, float] | None
    intervals: dict[str, list[float]] | None
    steps: list[float]
    means: dict[str, float]
    averages: list[list[float]]
    alone: float
    other_lags: OtherLags | Callable[[], OtherLags] = field(default_factory=dict)
    own: list[float] = field(default_factory=list)

    def by_other_rules(self):
        """``other_lags``, computed."""
        return self.other_lags() if callable(self.other_lags) else self.other_lags

    @property
    def dt(self):
        """The longest time between samples, s."""
        return max(self.steps)

    def half(self, key):
        """Half the width of an interval."""
        return (self.intervals[key][1] - self.intervals[key][0]) / 2

    def reasons(self, spec):
        """The sorted reasons that these limits refuse it for."""
        margins = {
            "rmse": (-math.inf, spec["rmse_max"]),
            "bias": (-spec["bias_max"], spec["bias_max"]),
            "lag_s": (-spec["lag_max_s"], spec["lag_max_s"]),
            "coverage": (spec["coverage_min"], spec["coverage_max"]),
        }
        within = {
            key: margins[key][0] <= lo and hi <= margins[key][1] for key, (lo, hi) in self.intervals.items()
        }
        return sorted(key.removesuffix("_s") for key, kept in within.items() if not kept)


def of_used(used, report, sim, real, right):
    """Why the wrong runs are listed: they were used, too, or the numbers are those of the right ones."""
    if right.numbers is not None and any(_close(report, {key: right.numbers[key] for key in _EXACT})):
        return named("OTHER_RUNS_LISTED")
    fitted, lost = set(sim["calibrated_on"]), set(right.used) - set(used)
    if lost and set(used) < set(right.used) and all(any(run in name for name in fitted) for run in lost):
        return named("PART_OF_AN_ID")
    looks = any(any(_close(report, _numbers(sim, real, ids))) for ids in (set(used), fitted))
    return named("CALIBRATION_RUNS_SCORED") if looks and set(used) & fitted else None


#: The numbers that hardly come out right by chance.
_EXACT = ("rmse", "bias")


def _close(report, numbers):
    """Whether each of a report's numbers is one of these, whatever its sign; none where it is none at all."""
    for key in numbers:
        value = kit.attempt(lambda key=key: kit.as_number(report[key], key))
        yield value is not None and math.isclose(abs(value), abs(numbers[key]), rel_tol=1e-6)


def together(sim, real, ids):
    """The errors of the samples of these runs, of those that both sides have, and the sigmas."""
    known = {run["id"]: run["y"] for run in real["runs"]}
    runs = [run for run in sim["runs"] if run["id"] in known.keys() & set(ids)]
    e = [np.subtract(run["y"], known[run["id"]]) for run in runs]
    return np.concatenate([*e, np.empty(0)]), np.concatenate([*(run["sigma"] for run in runs), np.empty(0)])


def _numbers(sim, real, ids):
    """rmse and bias of the runs of these ids that both sides have."""
    e, _ = together(sim, real, ids)
    return {"rmse": float(np.sqrt(np.mean(e**2))), "bias": float(np.mean(e))} if len(e) else {}


def of_number(key, value, right, e, sigma):
    """What a wrong rmse, bias or coverage is, whatever else is wrong.

    Args:
        e, sigma: the errors of the samples that count, simulated minus real, and what was claimed of each.
    """
    numbers = {
        "rmse": (
            ("MEAN_OF_RUNS", right.means.get(key)),
            ("ROOT_MISSING", np.mean(e**2)),
            ("MEAN_REMOVED", np.std(e)),
            ("MEAN_ABSOLUTE", np.mean(np.abs(e))),
            ("BIAS_FOR_RMSE", np.mean(e)),
            ("NOT_AVERAGED", np.sqrt(np.sum(e**2))),
        ),
        "bias": (
            ("MEAN_OF_RUNS", right.means.get(key)),
            ("WRONG_SIGN", -np.mean(e)),
            ("MEAN_ABSOLUTE", np.mean(np.abs(e))),
            ("MEDIAN_FOR_MEAN", np.median(e)),
            ("NOT_AVERAGED", np.sum(e)),
        ),
        "coverage": (
            ("MEAN_OF_RUNS", right.means.get(key)),
            ("OUTSIDE_COUNTED", np.mean(np.abs(e) > 1.96 * sigma)),
            ("SIGMA_NOT_SCALED", np.mean(np.abs(e) <= sigma)),
            *(("SIGMA_MULTIPLE", np.mean(np.abs(e) <= z * sigma)) for z in (2.0, 1.645, 3.0)),
            *(("SIGMA_MISREAD", np.mean(np.abs(e) <= 1.96 * s)) for s in (np.sqrt(sigma), sigma**2)),
            ("OWN_SPREAD_FOR_SIGMA", np.mean(np.abs(e) <= 1.96 * np.std(e))),
            ("IN_PER_CENT", 100 * np.mean(np.abs(e) <= 1.96 * sigma)),
        ),
    }
    if key == "coverage" and value in {0.0, 1.0}:  # all or none, by whatever rule
        return None
    return _only(numbers[key], lambda wrong: wrong is not None and math.isclose(value, wrong, rel_tol=1e-6))


def _only(looks, fits):
    """The code of what fits, if all that fits has the same code."""
    codes = {code for code, wrong in looks if fits(wrong)}
    return named(codes.pop()) if len(codes) == 1 else None


def of_pairs(key, value, sim, real):
    """Whether a wrong rmse or bias is that of runs paired by their place in the two lists.

    By the place in the lists as they are, or in what is left of each, or of the simulated ones, without the
    runs that do not count.
    """
    if key == "coverage":
        return None
    ids = {run["id"] for run in real["runs"]} - set(sim["calibrated_on"])
    count = ids & {run["id"] for run in sim["runs"]}
    whole = [(s, r) for s, r in zip(sim["runs"], real["runs"], strict=False) if s["id"] in ids]
    left = zip(*([run for run in side["runs"] if run["id"] in count] for side in (sim, real)), strict=True)
    fresh = [run for run in sim["runs"] if run["id"] not in sim["calibrated_on"]]
    for pairs in (whole, list(left), list(zip(fresh, real["runs"], strict=False))):
        alike = all(s["id"] == r["id"] for s, r in pairs)
        if alike or any(len(s["y"]) != len(r["y"]) for s, r in pairs):
            continue
        e = np.concatenate([np.asarray(s["y"]) - np.asarray(r["y"]) for s, r in pairs])
        wrong = np.mean(e) if key == "bias" else np.sqrt(np.mean(e**2))
        if math.isclose(value, wrong, rel_tol=1e-6):
            return named("MATCHED_BY_POSITION")
    return None


#: Student's t, as the stub has it.
_T95 = (6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812)


def of_interval(key, ends, right):
    """What the ends of a wrong interval show, and what wrong intervals about right numbers have in common."""
    shares = [(ends[k][1] - ends[k][0]) / 2 / right.half(k) for k in NUMBERS if right.half(k) > 0]
    if shares and max(shares) < 0:
        return named("RETURNS_SWAPPED")
    if right.half(key) > 0 and abs(sum(ends[key]) / 2 - right.numbers[key]) <= 0.01 * right.half(key):
        share, n = (ends[key][1] - ends[key][0]) / 2 / right.half(key), len(right.used)
        t = _T95[n - 2]
        looks = [
            ("ZERO_WIDTH", 0.0),
            *(("JACKKNIFE_FACTOR", x / (n - 1)) for x in (math.sqrt(n), 1.0)),
            *(("JACKKNIFE_FACTOR", x) for x in (math.sqrt(n / (n - 1)), 1 / math.sqrt(n - 1), math.sqrt(n))),
            *(
                ("NOT_STUDENTS_T", z / t)
                for z in (1.0, 1.645, 1.96, 2.0, 3.0, _T95[n - 1], *_T95[n - 3 : n - 2])
            ),
        ]
        # Where the width is right, or a wrong rule would give about the right one, it tells nothing.
        found = _only(looks, lambda wrong: abs(share - wrong) < 1e-3 * max(wrong, 1e-6))
        if found and abs(share - 1) > 2e-3:
            return found
    middles = [abs(sum(ends[k]) / 2 - right.numbers[k]) <= 0.01 * right.half(k) for k in NUMBERS]
    alike = len(shares) > 1 and 0.01 < max(shares) <= (1 + 1e-5) * min(shares)
    return named("INTERVALS_SCALED") if alike and all(middles) and abs(shares[0] - 1) > 2e-3 else None


def of_lag(submission, value, half, right):
    """What a wrong lag is, or that it is not the best.

    Args:
        submission: asked for the lags of single runs.
        half: half the width of the interval that was given for it; nan if there is none.
        right: the facts.
    """
    late, dt = right.numbers["lag_s"], right.dt
    near = lambda wrong: abs(value - wrong) <= 0.3 * dt  # noqa: E731 - a search is that good
    looks = [
        ("LAG_SIGN", abs(late) > 0.6 * dt and near(-late)),
        # A number of samples is recognised only where it cannot be anything else.
        ("LAG_IN_SAMPLES", abs(late) > dt and any(abs(value * h - late) <= 0.6 * h for h in right.steps)),
        ("LAG_IN_SAMPLES", abs(late) > dt and abs(value / 1000 - late) <= 0.3 * dt),
        ("LAG_AT_THE_END", abs(value) >= 0.19),  # no lag is larger than 0.2 s
        ("LAG_WHOLE_SAMPLES", abs(value - late) < 1.01 * dt and _whole(value, right)),
    ]
    # What single runs show of the search goes first: another rule may give about this lag by chance.
    code = next((code for code, fits in looks if fits), None) or _of_single_lags(submission, value, right)
    return named(code or _by_other_rule(value, half, right) or _of_runs(value, half, right) or "LAG_NOT_BEST")


def _of_runs(value, half, right):
    """Which lag of the runs, each by itself, this one is."""
    if _about(value, half, right.averages, right.dt):
        return "LAG_MEAN_OF_RUNS"
    # The lags of several runs are only some steps apart: what is near one may be so by chance.
    if any(abs(value - lag) <= 0.01 * right.dt for lag in right.own):
        return "LAG_OF_ONE_RUN"
    return "LAG_NOT_NEGATIVE" if right.numbers["lag_s"] < -0.6 * right.dt and value >= 0 else None


#: Lags of single runs that are asked for, s; the step is 0.02 s.
_SINGLE = (0.046, 0.0535, -0.046, 0.17, -0.17, 0.0312, 0.0269)


def _of_single_lags(submission, value, right):
    """What the lags of single runs without noise show of the search, if a wrong lag may come from that."""
    return kit.attempt(lambda: _single_lags(submission, value, right))


def _single_lags(submission, value, right):
    t = 0.02 * np.arange(200)
    speed = lambda t: 1.3 + np.sin(5.0 * t) + 0.4 * np.sin(8.2 * t + 1.0)  # noqa: E731
    spec = {"rmse_max": 1.0, "bias_max": 1.0, "lag_max_s": 1.0, "coverage_min": 0.0, "coverage_max": 1.0}
    calls = []
    for late in _SINGLE:
        ours = {"id": "a", "t": t.copy(), "y": speed(t - late), "sigma": np.ones(len(t))}
        theirs = {"id": "a", "t": t.copy(), "y": speed(t)}
        calls.append(({"calibrated_on": [], "runs": [ours]}, {"runs": [theirs]}, spec))
    reports = submission.call_each("validate", calls)
    lags = [kit.as_number(one.get("lag_s") if isinstance(one, dict) else None) for one in reports]
    kept = [abs(lag - late) < 0.002 for lag, late in zip(lags, _SINGLE, strict=True)]
    late = right.numbers["lag_s"]
    if not kept[0] and abs(value - late) <= right.dt:
        for step in (0.02, 0.01, 0.005):
            mirrored = [2 * step * round(known / step) - known for known in _SINGLE]
            if np.allclose(np.delete(np.subtract(lags, mirrored), [3, 4]), 0.0, atol=0.15 * step):
                return "LAG_PARABOLA_BACKWARDS"
    if kept[:5] == [True, True, False, True, False] and late < 0:
        return "LAG_EARLY_MISSED"
    short = kept[:3] == [True] * 3 and not any(kept[3:5])
    return "LAG_SEARCH_SHORT" if short and abs(late) > 0.06 else None


#: How shifts are compared, and whose lags these are.
_OTHER_RULES = {
    "even": "LAG_OF_EVEN_RUNS",
    "sum": "LAG_OF_SUMS",
    "outside": "LAG_PAST_THE_END",
    "product": "LAG_OF_PRODUCTS",
    "shapes": "LAG_OF_SHAPES",
    "alike": "LAG_OF_ONE_STEP",
}


def _by_other_rule(value, half, right):
    """The code of the other rule that gives about this lag and this interval; None if there are several."""
    codes = {
        _OTHER_RULES[name]
        for name, some in right.by_other_rules().items()
        if any(_about(value, half, [pair], right.dt) for pair in some)
    }
    return codes.pop() if len(codes) == 1 else None


def _about(value, half, known, dt):
    """Whether a lag, and half the width of its interval, are about one of these pairs."""
    return any(
        abs(value - pair[0]) <= 0.06 * dt and abs(half - pair[1]) <= 0.2 * dt for pair in known if pair
    )


def _whole(value, right):
    """Whether it is a whole number of samples."""
    return any(abs(value / step - round(value / step)) < 1e-6 for step in right.steps)


def of_lag_interval(submission, value, half, right):
    """Why the interval of a lag is wrong, where the lag itself and the other intervals are right.

    half: half the width that was given.
    """
    if abs(half) < 1e-9:
        return named("ZERO_WIDTH")
    if _whole(value, right):
        return named("LAG_WHOLE_SAMPLES")
    if code := _of_single_lags(submission, value, right) or _by_other_rule(value, half, right):
        return named(code)
    if right.alone and abs(half / right.alone - 1) < 0.03:
        return named("LAGS_OF_SINGLE_RUNS")
    return named("LAG_OF_PARTS")


def of_reasons(judged, shown=None):
    """What reasons show by themselves: (those given, the right ones) of each report, and of the shown one."""
    if all(sorted(reasons) == right for reasons, right in judged):
        return named("NOT_SORTED")
    words = {key.removesuffix("_s") for key in MEASURES}
    if any(set(reasons) - words for reasons, _ in judged):
        return named("REASON_UNKNOWN")
    if all(sorted(set(reasons)) == right for reasons, right in judged):
        return named("REASON_TWICE")
    reasons, right = shown or judged[0]
    missing = set(right) - set(reasons)
    return named("REASON_MISSING" if missing else "REASON_TOO_MANY")


def of_far_off(reasons):
    """What is wrong with the reasons against a simulation that is far off."""
    known = {key.removesuffix("_s") for key in MEASURES}
    return named("REASON_UNKNOWN" if reasons - known else "REASON_MISSING")

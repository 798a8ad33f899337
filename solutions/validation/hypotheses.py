"""Wrong programs for the tasks of ``validation``, as functions: what a diagnosis is compared with.

Those of the metrics are in ``formulas.py``; here are cross-validation and the verdict.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.scoring import kit

model, formulas, facts = (kit.sibling(__file__, name) for name in ("validation", "formulas", "facts"))
MEASURES = facts.MEASURES
_SOME = (MEASURES, ("rmse",), ("bias",), ("coverage",))


def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for task, families in TERMS.items():
        for code, function in formulas.OTHERS.get(task, ()):
            yield task, (code,), function
        for family, terms in families:
            for term, (code, form) in ((term, entry) for term in terms for entry in terms[term]):
                yield task, (code,), family(**{term: form})
    for task, ((family, terms), *_) in TERMS.items():
        # Two terms wrong at once, each in the first form of its code.
        firsts = {term: dict(reversed(forms)).items() for term, forms in terms.items()}
        pairs = [
            ((code, second), {one: form, other: another})
            for one, other in itertools.combinations(terms, 2)
            for (code, form), (second, another) in itertools.product(firsts[one], firsts[other])
            if code != second
        ]
        for codes, wrong in pairs[:: max(1, len(pairs) // _MOST)]:
            yield task, codes, family(**wrong)


#: Programs with two mistakes that are made for a task, spread evenly over what there is.
_MOST = 200

# -- cross-validation -----------------------------------------------------------------------------------


def _cross_validate(
    cut=lambda n, k: np.array_split(np.arange(n), k),
    seen=lambda fold, n, first: [i for i in range(n) if i not in fold],
    score=lambda e: np.sqrt(np.mean(np.concatenate(e) ** 2)),
    gives=list,
):
    """``seen``: which runs a model is fitted to; ``score``: of the errors of each run of a fold."""

    def cross_validate(fit, predict, runs, k):
        folds, scores = cut(len(runs), k), []
        for fold in folds:
            model = fit([runs[i] for i in seen(fold, len(runs), folds[0])])
            scores.append(score([predict(model, runs[i]) - runs[i]["y"] for i in fold]))
        return np.array(gives(scores))

    return cross_validate


_FOLDS = {
    "score": (
        ("MEAN_OF_RUNS", lambda e: np.mean([np.sqrt(np.mean(run**2)) for run in e])),
        ("MEAN_OF_RUNS", lambda e: np.sqrt(np.mean([np.mean(run**2) for run in e]))),
        ("ROOT_MISSING", lambda e: np.mean(np.concatenate(e) ** 2)),
        ("NOT_AVERAGED", lambda e: np.sqrt(np.sum(np.concatenate(e) ** 2))),
        ("SUM_OF_RUNS", lambda e: np.sum([np.sqrt(np.mean(run**2)) for run in e])),
        ("MEAN_REMOVED", lambda e: np.std(np.concatenate(e))),
        ("MEAN_ABSOLUTE", lambda e: np.mean(np.abs(np.concatenate(e)))),
        ("BIAS_FOR_RMSE", lambda e: np.mean(np.concatenate(e))),
        ("MEDIAN_FOR_MEAN", lambda e: np.sqrt(np.median(np.concatenate(e) ** 2))),
        ("LAST_RUN_ALONE", lambda e: np.sqrt(np.mean(e[-1] ** 2))),
    ),
    "cut": (
        ("NOT_CONTIGUOUS", lambda n, k: [np.arange(i, n, k) for i in range(k)]),
        ("FOLDS_UNEVEN", lambda n, k: [np.arange(i * (n // k), (i + 1) * (n // k)) for i in range(k)]),
    ),
    "seen": (
        ("LEAKS_HELD_OUT", lambda fold, n, first: range(n)),
        ("FITS_THE_FOLD", lambda fold, n, first: fold),
        ("LEAKS_HELD_OUT", lambda fold, n, first: [i for i in range(n) if i not in first]),
    ),
    "gives": (("FOLDS_REVERSED", lambda scores: scores[::-1]),),
}

# -- the verdict ----------------------------------------------------------------------------------------


def _together(pairs, key, of):
    return of(key, *facts.together(pairs))


def _only(key, other):
    """One number by another rule: a function of the errors and sigmas."""
    return lambda asked, e, sigma: other(e, sigma) if asked == key else facts.number(asked, e, sigma)


def _t(n):
    return model.T95[n - 2]


def _spread(rest):
    return facts.error(rest) * math.sqrt(len(rest) / (len(rest) - 1))


def _sampled(key, pairs):
    """The standard error that a number would have, were all samples independent."""
    e, sigma = facts.together(pairs)
    share, root = facts.number("coverage", e, sigma), math.sqrt(len(e))
    if key == "coverage":
        return math.sqrt(share * (1 - share)) / root
    return np.std(e**2) / (2 * np.sqrt(np.mean(e**2))) / root if key == "rmse" else np.std(e) / root


def _outside(value, ends, margin):
    return not (margin[0] <= ends[0] and ends[1] <= margin[1])


_LAGS = {}


def _lag(pairs):
    """The lag of these runs, searched for once."""
    key = tuple((s["id"], np.asarray(s["y"]).tobytes()) for s, _ in pairs)
    if key not in _LAGS:
        _LAGS[key] = model.best_shift(pairs)
    return _LAGS[key]


def _step(pairs):
    """The smallest step of the runs, s."""
    return min(float(s["t"][1] - s["t"][0]) for s, _ in pairs)


def _validate(
    pairs=model.held_out_pairs,
    number=facts.number,
    pool=_together,
    lag=_lag,
    half=lambda key, n, rest, *_: facts.half(rest),
    middle=lambda value, without: value,
    wrong=lambda key, *known: _outside(*known),
    order=sorted,
    few=lambda report: report,
):
    """``half``: of the width of an interval; ``wrong``: whether it speaks against; ``few``: no interval."""

    def validate(sim, real, spec):
        some = pairs(sim, real)
        measure = lambda key, some: float(lag(some) if key == "lag_s" else pool(some, key, number))  # noqa: E731
        numbers = {key: measure(key, some) if some else None for key in MEASURES}
        report = {"accepted": False, **numbers, "intervals": None, "runs_used": [s["id"] for s, _ in some]}
        n = len(some)
        if n < 2:
            return few({**report, "reasons": ["single_run" if some else "calibration_data"]})
        margins = {
            "rmse": (-math.inf, spec["rmse_max"]),
            "bias": (-spec["bias_max"], spec["bias_max"]),
            "lag_s": (-spec["lag_max_s"], spec["lag_max_s"]),
            "coverage": (spec["coverage_min"], spec["coverage_max"]),
        }
        intervals, reasons = {}, []
        for key, value in numbers.items():
            without = np.array([measure(key, some[:i] + some[i + 1 :]) for i in range(n)])
            alone = np.array([measure(key, [pair]) for pair in some])
            sampled = _sampled(key, some) if key != "lag_s" else 0.0
            width, centre = half(key, n, without, alone, sampled), middle(value, without)
            intervals[key] = (centre - width, centre + width)
            if wrong(key, value, intervals[key], margins[key]):
                reasons.append(key.removesuffix("_s"))
        return {**report, "accepted": not reasons, "reasons": order(reasons), "intervals": intervals}

    return validate


def _all_pairs(sim, real, ids=None):
    known = {run["id"]: run for run in real["runs"] if ids is None or run["id"] in ids}
    return [(run, known[run["id"]]) for run in sim["runs"] if run["id"] in known]


def _by_place(sim, real):
    pairs = zip(sim["runs"], real["runs"], strict=False)
    return [(s, r) for s, r in pairs if s["id"] not in sim["calibrated_on"]]


def _by_place_if_known(sim, real):
    known = {run["id"] for run in real["runs"]}
    return [(s, r) for s, r in _by_place(sim, real) if s["id"] in known]


def _mean_of_runs(keys):
    def pool(pairs, key, of):
        alone = [_together([pair], key, of) for pair in pairs]
        return np.mean(alone) if key in keys else _together(pairs, key, of)

    return pool


def _covered(within):
    """A coverage by another rule; ``within``: of the errors and sigmas."""
    return _only("coverage", lambda e, sigma: np.mean(within(e, sigma)))


#: (code, half the width): of n runs, of values without each, of each alone, and the error if samples counted.
_RULES = [
    *(("JACKKNIFE_FACTOR", lambda n, rest, *_, p=p: _t(n) * _spread(rest) / n**p) for p in (0, 0.5, 1)),
    *(
        ("JACKKNIFE_FACTOR", lambda n, rest, *_, by=by: _t(n) * _spread(rest) / math.sqrt((n - 1) * n**by))
        for by in (0, 1)
    ),
    *(
        ("NOT_STUDENTS_T", lambda n, rest, *_, z=z: z * facts.error(rest))
        for z in (1.0, 1.645, 1.96, 2.0, 3.0)
    ),
    *(
        ("NOT_STUDENTS_T", lambda n, rest, *_, table=table: table[n - 2] * facts.error(rest))
        for table in (model.T95[1:], (0.0, *model.T95), (12.706, 4.303, 3.182, 2.776, 2.571))
    ),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, _: _t(n) * np.std(alone, ddof=1) / math.sqrt(n)),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, _: _t(n) * np.std(alone, ddof=1)),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, _: _t(n) * np.std(alone)),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, _: _t(n) * facts.error(alone)),
    ("ZERO_WIDTH", lambda *_: 0.0),
    *(("SAMPLES_COUNTED", lambda n, rest, alone, own, z=z: z * own) for z in (1.0, 1.645, 1.96, 2.0)),
    ("SAMPLES_COUNTED", lambda n, rest, alone, own: _t(n) * own),
]


def _in_some(code, half):
    """A rule for the width of all intervals, and of one alone; of samples there is no lag."""
    for some in _SOME:
        keys = [key for key in some if code != "SAMPLES_COUNTED" or key != "lag_s"]
        yield lambda key, *known, keys=keys: half(*known) if key in keys else facts.half(known[1])


def _judging():
    """(code, ``wrong``): for some of the measures a rule, or for numbers in place of intervals."""
    signed, each = (("bias",), ("lag_s",), ("bias", "lag_s")), [(key,) for key in MEASURES]
    slips = [
        *(
            ("SIGN_OF_LIMIT_IGNORED", keys, lambda value, ends, margin: ends[1] > margin[1])
            for keys in signed
        ),
        *(
            ("SIGN_OF_LIMIT_IGNORED", keys, lambda value, *known: value >= 0 and _outside(value, *known))
            for keys in signed
        ),
        ("OVER_COVERAGE_ACCEPTED", ("coverage",), lambda value, ends, margin: ends[0] < margin[0]),
        ("RMSE_ALONE_JUDGED", MEASURES[1:], lambda *known: False),
        *(("MEASURE_NOT_JUDGED", keys, lambda *known: False) for keys in each),
        *(
            ("BURDEN_REVERSED", keys, lambda value, ends, margin: ends[1] < margin[0] or ends[0] > margin[1])
            for keys in (MEASURES, *each)
        ),
        ("POINT_ESTIMATE_JUDGED", (), None),
    ]
    for code, keys, rule in slips:
        if code != "POINT_ESTIMATE_JUDGED":
            yield code, _by_rule(keys, rule)
        # Of a number there is no more to say, and a measure that is not judged has none.
        if code not in {"BURDEN_REVERSED", "MEASURE_NOT_JUDGED"}:
            yield code, _by_rule(keys, rule, points=True)


def _by_rule(keys, rule, points=False):
    def wrong(key, value, ends, margin):
        ends = (value, value) if points else ends
        return (rule if key in keys else _outside)(value, ends, margin)

    return wrong


_VERDICT = {
    "pairs": (
        ("CALIBRATION_RUNS_SCORED", _all_pairs),
        ("CALIBRATION_RUNS_SCORED", lambda sim, real: _all_pairs(sim, real, sim["calibrated_on"])),
        ("MATCHED_BY_POSITION", _by_place),
        ("MATCHED_BY_POSITION", _by_place_if_known),
    ),
    "number": (
        ("WRONG_SIGN", lambda key, e, sigma: facts.number(key, -e, sigma)),
        ("ROOT_MISSING", _only("rmse", lambda e, sigma: np.mean(e**2))),
        ("MEAN_REMOVED", _only("rmse", lambda e, sigma: np.std(e))),
        ("BIAS_FOR_RMSE", _only("rmse", lambda e, sigma: np.mean(e))),
        ("MEAN_ABSOLUTE", _only("rmse", lambda e, sigma: np.mean(np.abs(e)))),
        ("MEAN_ABSOLUTE", _only("bias", lambda e, sigma: np.mean(np.abs(e)))),
        ("UNSIGNED", _only("bias", lambda e, sigma: abs(np.mean(e)))),
        ("MEDIAN_FOR_MEAN", _only("bias", lambda e, sigma: np.median(e))),
        ("IN_PER_CENT", _covered(lambda e, sigma: 100.0 * (np.abs(e) <= 1.96 * sigma))),
        ("OUTSIDE_COUNTED", _covered(lambda e, sigma: np.abs(e) > 1.96 * sigma)),
        ("SIGMA_NOT_SCALED", _covered(lambda e, sigma: np.abs(e) <= sigma)),
        ("SIGMA_MULTIPLE", _covered(lambda e, sigma: np.abs(e) <= 2.0 * sigma)),
        ("SIGMA_MULTIPLE", _covered(lambda e, sigma: np.abs(e) <= 1.645 * sigma)),
        ("SIGMA_MULTIPLE", _covered(lambda e, sigma: np.abs(e) <= 3.0 * sigma)),
        ("SIGMA_MISREAD", _covered(lambda e, sigma: np.abs(e) <= 1.96 * np.sqrt(sigma))),
        ("SIGMA_MISREAD", _covered(lambda e, sigma: np.abs(e) <= 1.96 * sigma**2)),
        ("SIGMA_MISREAD", _covered(lambda e, sigma: np.abs(e) <= 1.96 * np.mean(sigma))),
        ("OWN_SPREAD_FOR_SIGMA", _covered(lambda e, sigma: np.abs(e) <= 1.96 * np.std(e))),
        ("SIGMA_ONE_SIDED", _covered(lambda e, sigma: e <= 1.96 * sigma)),
    ),
    "pool": tuple(("MEAN_OF_RUNS", _mean_of_runs(keys)) for keys in _SOME),
    "lag": (
        ("LAG_SIGN", lambda pairs: -_lag(pairs)),
        ("LAG_SIGN", lambda pairs: abs(_lag(pairs))),
        ("LAG_IN_SAMPLES", lambda pairs: _lag(pairs) / (pairs[0][1]["t"][1] - pairs[0][1]["t"][0])),
        ("LAG_WHOLE_SAMPLES", lambda pairs: round(_lag(pairs) / _step(pairs)) * _step(pairs)),
        ("LAG_MEAN_OF_RUNS", lambda pairs: np.mean([_lag([pair]) for pair in pairs])),
        ("LAG_NOT_BEST", lambda pairs: _lag(pairs[:1])),
    ),
    "half": tuple((code, form) for code, half in _RULES for form in _in_some(code, half)),
    "middle": (("CENTRED_ON_THE_REST", lambda value, without: np.mean(without)),),
    "wrong": tuple(_judging()),
    "few": (
        ("NOTHING_LEFT", lambda report: {**report, "accepted": True, "reasons": []}),
        ("NOTHING_LEFT", lambda report: {**report, "reasons": []}),
    ),
}

TERMS = formulas.TERMS | {
    "cross_validate": [(_cross_validate, _FOLDS)],
    "validate": [(_validate, _VERDICT)],
}

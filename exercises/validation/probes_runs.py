"""The tasks of ``validation`` that work on whole recordings: what a submission does with them, and which
mistake that looks like.

The bootstrap is recognised by the resamples it asks the statistic about, cross-validation by who was fitted
to what, and a verdict by its numbers.
"""

from __future__ import annotations

import numpy as np

from course.grading import kit

named = kit.companion("validation", "diagnosis").named
_probes = kit.companion("validation", "probes")
match, callback = _probes.match, _probes.callback

# -- bootstrap ------------------------------------------------------------------------------------------

#: Blocks found may be this much longer or shorter than asked for. Over 10 resamples of 20 blocks the mean
#: length of random (stationary) blocks scatters by 7 %; blocks that are not random are off by 5 % at most.
BLOCK_FACTOR = 1.5
_N, _BLOCK, _BOOT = 240, 12, 10


def resamples(submission, seed):
    """The series whose values say where they stand, and every array the statistic is asked about."""
    e = np.arange(_N, dtype=float)
    statistic = callback(
        "statistic(samples)", lambda samples: float(np.mean(kit.as_vector(samples, None, "samples")))
    )
    statistic.during(
        lambda: submission.call(
            "block_bootstrap_ci", e, statistic, _BLOCK, _BOOT, 0.2, np.random.default_rng(seed)
        )
    )
    return e, [np.asarray(call[0], dtype=float) for call in statistic.calls]


def of_resamples(e, asked):
    """What is wrong with the resamples, as a code, or None."""
    if len(asked) < _BOOT:
        return "STATISTIC_IGNORED"
    drawn = [samples for samples in asked if not np.array_equal(samples, e)]
    if not drawn:
        return "NOT_RESAMPLED"
    if any(len(samples) != len(e) for samples in drawn):
        return "RESAMPLE_SIZE"
    steps = np.concatenate([np.diff(samples) for samples in drawn])
    follows = (steps == 1) | (steps == 1 - len(e))  # a circular block goes on at the start
    length = len(e) * len(drawn) / (np.sum(~follows) + len(drawn))
    if length < 1.5:
        return "IID_BOOTSTRAP"
    return None if _BLOCK / BLOCK_FACTOR <= length <= _BLOCK * BLOCK_FACTOR else "BLOCK_IGNORED"


def of_interval(submission, seed):
    """The mistake behind an interval of the wrong width, if the resamples show it."""
    code = of_resamples(*resamples(submission, seed))
    return named(code) if code else None


def of_width(submission, ends, statistics):
    """The mistake behind intervals of the wrong width around the statistics of their series."""
    beside = (ends[:, 1] < statistics) | (ends[:, 0] > statistics)
    found = of_interval(submission, 1)
    return found or (named("ENDS_ON_ONE_SIDE") if np.mean(beside) > 0.8 else None)


# -- cross-validation -----------------------------------------------------------------------------------


class Folds:
    """A fit and a predict that remember which runs they are given.

    The model is y = gain * u, least squares. A run is known by its ``u``, so it may come back as a copy and
    without its ``y``.

    Attributes:
        fitted: for each model, the places of its training runs.
        asked: for each model, the places of the runs it was to predict.
    """

    def __init__(self, runs):
        self.runs = runs
        self.fitted: list[list[int]] = []
        self.asked: list[list[int]] = []
        self._gains: list[float] = []

    def fit(self, runs):
        places = [self._place(run, "fit") for run in kit.as_list(runs, "what fit was given")]
        u = np.concatenate([self.runs[i]["u"] for i in places])
        y = np.concatenate([self.runs[i]["y"] for i in places])
        self.fitted.append(places)
        self.asked.append([])
        self._gains.append(float(u @ y / (u @ u)))
        return {"model": len(self.fitted) - 1}

    def predict(self, model, run):
        number = model.get("model") if isinstance(model, dict) else None
        if type(number) is not int or not 0 <= number < len(self.fitted):
            kit.fail(
                "Your code hands predict something that fit did not return.",
                help="Keep what fit returns as it is, and give it to predict first: predict(model, run).",
                diagnose="NOT_A_MODEL",
                expected="a model that fit returned",
                actual=model,
            )
        place = self._place(run, "predict")
        self.asked[number].append(place)
        return self._gains[number] * self.runs[place]["u"]

    def _place(self, run, function):
        u = np.asarray(run.get("u"), dtype=float) if isinstance(run, dict) and "u" in run else np.empty(0)
        place = next((i for i, known in enumerate(self.runs) if np.array_equal(u, known["u"])), None)
        if place is None:
            kit.fail(
                f"Your code hands {function} something that is not one of the runs.",
                help="fit gets a list of runs, predict gets a model and one run, each as it was in the list.",
                diagnose="NOT_A_RUN",
                expected="a run of the list",
                actual=run,
            )
        return place

    def cross_validate(self, submission, k):
        """What the submission returns."""
        fit, predict = callback("fit(runs)", self.fit), callback("predict(model, run)", self.predict)
        return fit.during(
            lambda: predict.during(lambda: submission.call("cross_validate", fit, predict, self.runs, k))
        )

    def fault(self, k):
        """What is wrong with who was fitted to what, as a code, or None."""
        models = zip(self.fitted, self.asked, strict=True)
        used = [(set(fit), sorted(set(asked))) for fit, asked in models if asked]
        everything = set(range(len(self.runs)))
        if not used:
            return "FOLDS_UNEVEN"
        if len(used) == 1 and used[0][0] == everything:
            return "FITS_ONCE"
        if any(fit & set(asked) for fit, asked in used):
            swapped = all(fit == set(asked) for fit, asked in used)
            return "SCORES_TRAINING" if swapped and used[0][0] != everything else "LEAKS_HELD_OUT"
        if any(asked[-1] - asked[0] + 1 != len(asked) for _, asked in used):
            return "NOT_CONTIGUOUS"
        sizes = [len(asked) for _, asked in used]
        covered = sorted(i for _, asked in used for i in asked) == sorted(everything)
        if len(used) != k or not covered or max(sizes) - min(sizes) > 1:
            return "FOLDS_UNEVEN"
        return None if all(fit == everything - set(asked) for fit, asked in used) else "TRAINS_ON_TOO_LITTLE"

    def residuals(self):
        """For each fold in the order of the list, the errors of its runs, one array each."""
        models = [m for m, asked in enumerate(self.asked) if asked]
        models.sort(key=lambda m: min(self.asked[m]))
        return [
            [self._gains[m] * self.runs[i]["u"] - self.runs[i]["y"] for i in sorted(set(self.asked[m]))]
            for m in models
        ]


def of_scores(scores, residuals):
    """What wrong scores of right folds are."""
    squares = [[np.mean(e**2) for e in fold] for fold in residuals]
    pooled = np.array([np.mean(np.concatenate(fold) ** 2) for fold in residuals])
    return match(
        scores,
        [
            ("MEAN_OF_RUNS", np.array([np.mean(np.sqrt(fold)) for fold in squares])),
            ("MEAN_OF_RUNS", np.array([np.sqrt(np.mean(fold)) for fold in squares])),
            ("ROOT_MISSING", pooled),
            ("NOT_AVERAGED", np.array([np.sqrt(np.sum(np.concatenate(f) ** 2)) for f in residuals])),
            ("MEAN_REMOVED", np.array([np.std(np.concatenate(fold)) for fold in residuals])),
            ("MEAN_ABSOLUTE", np.array([np.mean(np.abs(np.concatenate(f))) for f in residuals])),
        ],
    )


# -- the verdict ----------------------------------------------------------------------------------------

KEYS = ("accepted", "reasons", "rmse", "bias", "lag_s", "coverage", "runs_used")
NUMBERS = ("rmse", "bias", "coverage")


def of_used(used, sim, real):
    """Why the wrong runs were used."""
    calibrated = set(sim["calibrated_on"])
    common = {run["id"] for run in sim["runs"]} & {run["id"] for run in real["runs"]}
    return named("CALIBRATION_RUNS_SCORED") if set(used) & calibrated & common else None


def of_number(key, value, sim, real):
    """What a wrong rmse, bias or coverage is."""
    known = {run["id"]: run for run in real["runs"]}
    common = [(run, known[run["id"]]) for run in sim["runs"] if run["id"] in known]
    fresh = [pair for pair in common if pair[0]["id"] not in sim["calibrated_on"]]
    in_order = zip(sim["runs"], real["runs"], strict=False)
    placed = [(s, r) for s, r in in_order if len(s["y"]) == len(r["y"])]
    candidates = [("CALIBRATION_RUNS_SCORED", _pooled(key, common))]
    candidates += [("MEAN_OF_RUNS", np.mean([_pooled(key, [pair]) for pair in fresh]))]
    candidates += [(code, wrong) for code, wrong in _slips(key, fresh)]
    for pairs in (placed, [pair for pair in placed if pair[0]["id"] not in sim["calibrated_on"]]):
        if pairs:
            candidates.append(("MATCHED_BY_POSITION", _pooled(key, pairs)))
    return match(value, candidates)


def _pooled(key, pairs, reach=1.96):
    e = np.concatenate([s["y"] - r["y"] for s, r in pairs])
    sigma = np.concatenate([s["sigma"] for s, _ in pairs])
    if key == "coverage":
        return np.mean(np.abs(e) <= reach * sigma)
    return np.sqrt(np.mean(e**2)) if key == "rmse" else np.mean(e)


def _slips(key, pairs):
    """(code, value) of the usual slips with the right runs."""
    e = np.concatenate([s["y"] - r["y"] for s, r in pairs])
    right = _pooled(key, pairs)
    if key == "rmse":
        return [("ROOT_MISSING", np.mean(e**2)), ("MEAN_REMOVED", np.std(e)), ("BIAS_FOR_RMSE", np.mean(e))]
    if key == "bias":
        return [("WRONG_SIGN", -right), ("MEAN_ABSOLUTE", np.mean(np.abs(e)))]
    return [
        ("SIGMA_NOT_SCALED", _pooled(key, pairs, 1.0)),
        ("IN_PER_CENT", 100 * right),
        ("OUTSIDE_COUNTED", 1 - right),
    ]


def of_lag(value, late, dt):
    """What a wrong lag is; the simulation is ``late`` seconds late."""
    if abs(value + late) <= 0.3 * dt:
        return named("LAG_SIGN")
    samples = value / dt
    if abs(samples - round(samples)) < 1e-6 and abs(value - late) < 1.01 * dt:
        return named("LAG_WHOLE_SAMPLES")
    return named("LAG_IN_SAMPLES") if abs(abs(value * dt) - abs(late)) < 1.01 * dt else None


def of_reasons(reasons, expected, numbers):
    """What is wrong with a list of reasons."""
    if sorted(reasons) == sorted(expected):
        return named("NOT_SORTED")
    signed = {"bias": numbers["bias"], "lag": numbers["lag_s"]}
    missing = set(expected) - set(reasons)
    if missing and all(signed.get(reason, 0) < 0 for reason in missing):
        return named("SIGN_OF_LIMIT_IGNORED")
    return named("REASON_MISSING" if missing else "REASON_TOO_MANY")


#: A lag is right to this share of the time between samples. Correct searches were off by at most 0.05
#: (calibration table); one in whole samples is off by 0.3 or more here.
LAG_SHARE = 0.2


def expect_report(submission, sim, real, spec, expected, shown):
    """``validate`` gives the expected report. ``shown`` is what a finding says about the case."""
    report = kit.as_record(submission.call("validate", sim, real, spec), KEYS, "the report")
    used = [str(item) for item in kit.as_list(report["runs_used"], "runs_used")]
    kit.expect_equal(
        sorted(used),
        sorted(expected["runs_used"]),
        message="The verdict rests on other runs than it should.",
        help="Use the runs that both sides have, without those the simulation was calibrated on.",
        input=shown,
        diagnose=lambda: of_used(used, sim, real),
    )
    for key in NUMBERS:
        value = kit.as_number(report[key], key)
        kit.expect_close(
            value,
            expected[key],
            rel=1e-6,
            abs=1e-9,
            source="a closed formula: only rounding is allowed",
            quantity=key,
            message=f"`{key}` is wrong.",
            help="Pool the samples of all runs that count, with errors simulated minus real.",
            input=shown,
            diagnose=lambda key=key, value=value: of_number(key, value, sim, real),
        )
    dt = float(np.max([run["t"][1] - run["t"][0] for run in sim["runs"]]))
    lag = kit.as_number(report["lag_s"], "lag_s")
    kit.expect_close(
        lag,
        expected["lag_s"],
        abs=LAG_SHARE * dt,
        source="a fifth of the time between samples; correct searches use a quarter of that",
        quantity="lag_s",
        units="s",
        message="`lag_s` is not how late the simulation is.",
        help="Find the shift s for which sim(t + s) fits real(t) best, to a fraction of a sample.",
        input=shown,
        diagnose=lambda: of_lag(lag, expected["lag_s"], dt),
    )
    expect_verdict(report, expected, shown)


def expect_verdict(report, expected, shown):
    """The reasons and whether it is accepted."""
    reasons = [kit.as_text(item, "a reason") for item in kit.as_list(report["reasons"], "reasons")]
    kit.expect_equal(
        reasons,
        expected["reasons"],
        message="The reasons are not the ones that apply.",
        help="A reason for each number that breaks its limit, sorted by alphabet.",
        input=shown,
        diagnose=lambda: of_reasons(reasons, expected["reasons"], expected),
    )
    kit.expect_equal(
        kit.as_bool(report["accepted"], "accepted"),
        not expected["reasons"],
        message="`accepted` is wrong.",
        help="A simulation is accepted where there is no reason against it.",
        input=shown,
        diagnose="VERDICT_AGAINST_REASONS",
    )


def expect_nothing_left(submission, sim, real, spec, shown):
    """``validate`` says that there is nothing to judge by."""
    report = kit.as_record(submission.call("validate", sim, real, spec), KEYS, "the report")
    left = report["reasons"], [report[key] for key in (*NUMBERS, "lag_s")], report["runs_used"]
    kit.expect_true(
        list(left[0] or []) == ["calibration_data"]
        and left[1] == [None] * 4
        and kit.as_bool(report["accepted"], "accepted") is False
        and not kit.as_list(left[2], "runs_used"),
        "Every run was used to calibrate the simulation, and the report does not say that and nothing else.",
        help="The only reason is calibration_data, the four numbers are None, runs_used is empty, and it is "
        "not accepted.",
        input=shown,
        actual=report,
        diagnose=lambda: named("CALIBRATION_RUNS_SCORED" if report["runs_used"] else "NOTHING_LEFT"),
    )

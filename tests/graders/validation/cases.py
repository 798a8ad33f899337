"""Data that the hidden graders of ``validation`` draw, and what they expect of it."""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

probes = kit.companion("validation", "probes")
runs = kit.companion("validation", "probes_runs")
shared = kit.companion("validation", "expectations")
twins = kit.companion("validation", "twins")

#: Limits that a good twin keeps and a bad one breaks by far: the noise is 0.02 to 0.03, sines have an
#: amplitude of 0.4 to 0.7, a mass that is off by a quarter or a lag of 0.04 s costs at least 0.1.
SPEC = {"rmse_max": 0.06, "bias_max": 0.03, "lag_max_s": 0.012, "coverage_min": 0.9}


def expect_normalised(submission, task, rng, shapes, names):
    """nees or nis of errors with covariances of their own, far from diagonal; (d, rows) in ``shapes``."""
    drawn = [_errors(rng, d, rows) for d, rows in shapes]
    values = submission.call_each(task, drawn)
    for value, (err, covariance) in zip(values, drawn, strict=True):
        expected = np.einsum("ni,nij,nj->n", err, np.linalg.inv(covariance), err)
        shared.expect_normalised(task, value, err, covariance, expected, names)


def _errors(rng, d, rows):
    """Errors and their covariances; components differ in size by up to a hundred."""
    sizes = 10.0 ** rng.uniform(-1, 1, d)
    factors = (rng.standard_normal((rows, d, d)) + 1.5 * np.eye(d)) * sizes[:, None]
    covariance = factors @ factors.transpose(0, 2, 1) + 0.05 * np.diag(sizes**2)
    return np.einsum("nij,nj->ni", factors, rng.standard_normal((rows, d))), covariance


def expect_centred(submission, ends, statistics, shown):
    """Each interval has its statistic about in its middle, in the mean over all."""
    middle = np.mean(ends, axis=1)
    width = np.mean(ends[:, 1] - ends[:, 0])
    kit.expect_bounded(
        float(np.mean(np.abs(middle - statistics)) / width),
        high=0.35,
        source="correct variants stay below 0.2 over 200 seeds",
        quantity="distance of the middle from the statistic, in widths",
        input=shown,
        message="The intervals do not lie where they should.",
        help="The ends are quantiles of the statistic over the resamples.",
        diagnose=lambda: runs.of_interval(submission, 1) or probes.named("NOT_CENTRED"),
    )


def expect_level(submission, rng, statistic):
    """From alpha 0.32 to 0.05 an interval grows as the quantiles do; chance comes from rng alone."""
    series = shared.correlated(int(rng.integers(2**31)), 8, 240, 0.6)
    seeds = [int(s) for s in rng.integers(2**31, size=len(series))]
    calls = [
        (e, statistic, 16, 120, alpha, np.random.default_rng(seed))
        for alpha in (0.05, 0.32)
        for e, seed in zip(series, seeds, strict=True)
    ]
    again = [(*calls[0][:-1], np.random.default_rng(seed)) for seed in (seeds[0], seeds[0] + 1)]
    ends = shared.interval_ends(submission.call_each("block_bootstrap_ci", calls + again))
    shown = {"N": 240, "block": 16, "n_boot": 120, "statistic": "mean of e**2, times a number"}
    _expect_chance(ends[[0, -2, -1]], shown)
    wide, narrow = ends[:8], ends[8:16]
    values = np.array([statistic(e) for e in series])
    expect_centred(submission, wide, values, shown)
    ratio = float(np.mean(wide[:, 1] - wide[:, 0]) / np.mean(narrow[:, 1] - narrow[:, 0]))
    kit.expect_bounded(
        ratio,
        low=1.55,
        high=2.5,
        source="1.97 for a normal distribution; correct variants over 200 seeds",
        quantity="width at alpha 0.05 over width at alpha 0.32",
        input=shown,
        message="The width of the interval does not follow alpha as it should.",
        help="alpha is the share outside, both sides together.",
        diagnose=lambda: _of_ratio(ratio),
    )


def _expect_chance(ends, shown):
    first, same, other = ends
    kit.expect_true(
        bool(np.array_equal(first, same)),
        "Two calls with the same arguments and generators in the same state differ.",
        help="All chance has to come from rng.",
        input=shown,
        diagnose=probes.named("GLOBAL_RNG"),
    )
    kit.expect_true(
        not np.array_equal(first, other),
        "Two calls with different generators give the same interval.",
        help="All chance has to come from rng.",
        input=shown,
        diagnose=probes.named("FIXED_SEED"),
    )


def _of_ratio(ratio):
    if ratio < 1:
        return probes.named("LEVEL_FOR_ALPHA")
    return probes.named("ONE_SIDED" if ratio > 2.5 else "ONE_STANDARD_ERROR")


def pushed_runs(rng, lengths):
    """Runs of a body that answers its push by a gain that differs a little from run to run."""
    data = []
    for i, n in enumerate(lengths):
        u = rng.standard_normal(int(n))
        y = rng.uniform(0.5, 2.0) * u + 0.1 * rng.standard_normal(int(n))
        data.append({"id": f"run {i}", "u": u, "y": y})
    return data


def recordings(rng, count=4, dt=None):
    """Runs of the real cart, of different length; also of different step unless ``dt`` is given."""
    return [
        twins.record(
            rng,
            f"{'pqrstuv'[i]}{rng.integers(100)}",
            rng.uniform(7, 11),
            dt or (0.01, 0.02)[i % 2],
            rng.uniform(0.02, 0.03),
        )
        for i in range(count)
    ]


def expect_verdict(submission, rng, recorded, sim, late, reasons):
    """``validate`` reports what the samples say, and these reasons."""
    sim, real = _scrambled(rng, recorded, sim)
    expected = {**_facts(sim, real), "lag_s": late, "reasons": reasons}
    runs.expect_report(submission, sim, real, SPEC, expected, _shown(sim))


def expect_refused(submission, rng, recorded, sim):
    """``validate`` refuses; which of lag and bias go with a large error is left open."""
    sim, real = _scrambled(rng, recorded, sim)
    expected = _facts(sim, real)
    report = kit.as_record(submission.call("validate", sim, real, SPEC), runs.KEYS, "the report")
    used = [str(item) for item in kit.as_list(report["runs_used"], "runs_used")]
    shown = _shown(sim)
    kit.expect_equal(
        sorted(used),
        sorted(expected["runs_used"]),
        message="The verdict rests on other runs than it should.",
        help="Use the runs that both sides have, without those the simulation was calibrated on.",
        input=shown,
        diagnose=lambda: runs.of_used(used, sim, real),
    )
    for key in runs.NUMBERS:
        value = kit.as_number(report[key], key)
        kit.expect_close(
            value,
            expected[key],
            rel=1e-6,
            abs=1e-9,
            source=shared.EXACT,
            quantity=key,
            message=f"`{key}` is wrong.",
            help="Pool the samples of all runs that count, with errors simulated minus real.",
            input=shown,
            diagnose=lambda key=key, value=value: runs.of_number(key, value, sim, real),
        )
    reasons = set(map(str, kit.as_list(report["reasons"], "reasons")))
    kit.expect_true(
        {"coverage", "rmse"} <= reasons <= {"bias", "coverage", "lag", "rmse"},
        "A simulation that is far off is not refused for the reasons that it gives.",
        help="Compare each number with its limit.",
        input=shown,
        actual=sorted(reasons),
        diagnose=probes.named("REASON_MISSING"),
    )
    kit.expect_true(
        kit.as_bool(report["accepted"], "accepted") is False,
        "A simulation that is far off is accepted.",
        help="A simulation is accepted where there is no reason against it.",
        input=shown,
        diagnose=probes.named("VERDICT_AGAINST_REASONS"),
    )


def _scrambled(rng, recorded, sim):
    """Both sides in orders of their own, and each with a run that the other lacks."""
    real = twins.measured(recorded)
    extra = twins.record(rng, "elsewhere", 6.0, 0.02, 0.02)
    lonely = twins.measured([extra])["runs"]
    ahead = twins.simulated([extra], mass=9.0)["runs"]
    ahead[0]["id"] = "never driven"
    runs_sim, runs_real = sim["runs"] + ahead, real["runs"] + lonely
    return (
        {
            "calibrated_on": sim["calibrated_on"],
            "runs": [runs_sim[i] for i in rng.permutation(len(runs_sim))],
        },
        {"runs": [runs_real[i] for i in rng.permutation(len(runs_real))]},
    )


def _facts(sim, real):
    """rmse, bias, coverage and the runs that count."""
    known = {run["id"]: run for run in real["runs"]}
    pairs = [
        (run, known[run["id"]])
        for run in sim["runs"]
        if run["id"] in known and run["id"] not in sim["calibrated_on"]
    ]
    e = np.concatenate([s["y"] - r["y"] for s, r in pairs])
    sigma = np.concatenate([s["sigma"] for s, _ in pairs])
    return {
        "rmse": math.sqrt(np.mean(e**2)),
        "bias": float(np.mean(e)),
        "coverage": float(np.mean(np.abs(e) <= 1.96 * sigma)),
        "runs_used": [s["id"] for s, _ in pairs],
    }


def _shown(sim):
    return {"runs": len(sim["runs"]), "calibrated_on": sim["calibrated_on"], "spec": SPEC}

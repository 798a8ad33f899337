"""Data that the hidden graders of ``validation`` draw, and what they expect of it."""

from __future__ import annotations

import numpy as np

from course.scoring import kit

probes = kit.companion("validation", "probes_verdict")
shared = kit.companion("validation", "expectations")
twins = kit.companion("validation", "twins")
bundles = kit.companion("validation", "bundles")

#: Limits that a good twin keeps and a bad one breaks by far: the noise is 0.02 to 0.03, sines have an
#: amplitude of 0.4 to 0.7, a mass that is off by a quarter or a lag of 0.04 s costs at least 0.1.
SPEC = {
    "rmse_max": 0.06,
    "bias_max": 0.03,
    "lag_max_s": 0.012,
    "coverage_min": 0.85,
    "coverage_max": 1.1,
}


def expect_normalised(submission, task, rng, shapes, names):
    """nees or nis of errors with covariances of their own, far from diagonal; (d, rows) in ``shapes``."""
    for d, rows in shapes:
        shared.expect_normalised(submission, task, *_errors(rng, d, rows), names)


def expect_whole(submission, task, rng, names):
    """The same where every error and every covariance is a whole number."""
    factors = rng.integers(-3, 4, (5, 2, 2))
    covariance = factors @ factors.transpose(0, 2, 1) + 2 * np.eye(2, dtype=int)
    shared.expect_normalised(submission, task, rng.integers(-9, 10, (5, 2)), covariance, names)


def _errors(rng, d, rows):
    """Errors and their covariances; components differ in size by up to a hundred."""
    sizes = 10.0 ** rng.uniform(-1, 1, d)
    factors = (rng.standard_normal((rows, d, d)) + 1.5 * np.eye(d)) * sizes[:, None]
    covariance = factors @ factors.transpose(0, 2, 1) + 0.05 * np.diag(sizes**2)
    return np.einsum("nij,nj->ni", factors, rng.standard_normal((rows, d))), covariance


def pushed_runs(rng, lengths):
    """Runs of a body that answers its push by a gain that differs a little from run to run."""
    data = []
    for i, n in enumerate(lengths):
        u = rng.standard_normal(int(n))
        y = rng.uniform(0.5, 2.0) * u + 0.1 * rng.standard_normal(int(n))
        data.append({"id": f"run {i}", "u": u, "y": y})
    return data


def recordings(rng, count=4, dts=(0.01, 0.02), swings=(1.0,)):
    """Runs of the real cart, of different length and start; with these steps and swings in turn."""
    return [
        twins.record(
            rng,
            f"{'pqrstuv'[i]}{rng.integers(100)}",
            rng.uniform(7, 11),
            dts[i % len(dts)],
            rng.uniform(0.02, 0.03),
            swing=swings[i % len(swings)],
            begin=rng.choice([0.0, rng.uniform(-2.0, 9.0)]),
        )
        for i in range(count)
    ]


def cut_short(rng):
    """Carts whose simulation is off to one side and late, in recordings that end in the middle of a swing.

    There the shift of the smallest mean square is another than that at which the shapes fit.
    """
    late, recorded = float(rng.uniform(0.03, 0.06)), []
    for i, swings in enumerate((3.25, 4.25, 5.25)):
        drive = twins.Wave(rng.uniform(-1, 1), rng.uniform(0.8, 1.1))
        t = 0.005 * np.arange(round(200 * swings))
        recorded.append(twins.Recording(f"cut {i}", t, drive, drive.speed(t), 2.0))
    sim = twins.simulated(recorded, late=late, offset=float(rng.choice([-1, 1]) * rng.uniform(0.3, 0.4)))
    return bundles.Case(recorded, sim, twins.measured(recorded), late)


def expect_verdict(submission, rng, recorded, sim, lates=0.0, **limits):
    """``validate`` reports what the samples say, and what the limits make of it."""
    expect_facts(submission, _scrambled(rng, recorded, sim, lates=lates), SPEC | limits)


def expect_facts(submission, case, spec):
    """``validate`` reports the facts of this case, and what these limits make of them."""
    bundles.expect_report(submission, case, spec, bundles.facts(case), _shown(case.sim, spec))


def expect_refused(submission, rng, recorded, sim, mass):
    """``validate`` refuses; which of lag and bias go with a large error is left open."""
    case = _scrambled(rng, recorded, sim, mass=mass)
    shown = _shown(case.sim, SPEC)
    value = submission.call("validate", case.sim, case.real, SPEC)
    report = kit.as_record(value, bundles.KEYS, "the report")
    bundles.expect_numbers(report, case, bundles.facts(case), shown)
    reasons = set(bundles.reasons_of(report))
    kit.expect_true(
        {"coverage", "rmse"} <= reasons <= {"bias", "coverage", "lag", "rmse"},
        "A simulation that is far off is not refused for the right reasons.",
        help="Compare each interval with its margin.",
        input=shown,
        actual=sorted(reasons),
        diagnose=lambda: probes.of_far_off(reasons),
    )
    bundles.expect_accepted(report, False, shown)


def _scrambled(rng, recorded, sim, **rest):
    """Both sides in orders of their own, and each with a run that the other lacks."""
    real = twins.measured(recorded)
    extra = twins.record(rng, "elsewhere", 6.0, 0.02, 0.02)
    lonely = twins.measured([extra])["runs"]
    ahead = twins.simulated([extra], mass=9.0)["runs"]
    ahead[0]["id"] = "never driven"
    runs_sim, runs_real = sim["runs"] + ahead, real["runs"] + lonely
    mixed = {
        "calibrated_on": sim["calibrated_on"],
        "runs": [runs_sim[i] for i in rng.permutation(len(runs_sim))],
    }
    real = {"runs": [runs_real[i] for i in rng.permutation(len(runs_real))]}
    return bundles.Case(recorded, mixed, real, **rest)


def _shown(sim, spec):
    return {"runs": len(sim["runs"]), "calibrated_on": sim["calibrated_on"], "spec": spec}

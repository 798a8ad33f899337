"""Public checks of ``validation``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.grading import kit

probes = kit.companion("validation", "probes")
runs = kit.companion("validation", "probes_runs")
shared = kit.companion("validation", "expectations")


@pytest.mark.task("rmse")
@pytest.mark.points(2)
def test_rmse_by_hand(submission):
    """rmse is the root of the mean square, a constant error included"""
    cases = [[3.0, -4.0, 0.0, 5.0], [2.0, 2.0, 2.0], [0.0, 0.0]]
    for e, value in zip(cases, submission.call_each("rmse", [(np.array(e),) for e in cases]), strict=True):
        kit.expect_close(
            value,
            math.sqrt(sum(x * x for x in e) / len(e)),
            abs=1e-12,
            source=shared.EXACT,
            quantity="rmse",
            units="m",
            input={"e": e},
            message="The root mean square error is wrong.",
            help="Square the errors, average the squares, take the root: in this order from right to left.",
            diagnose=lambda value=value, e=e: probes.of_rmse(value, e),
        )


@pytest.mark.task("bias_variance")
@pytest.mark.points(3)
def test_bias_variance_by_hand(submission):
    """Bias and variance of a few errors, the variance divided by N"""
    shared.expect_bias_variance(submission, [0.5, -0.2, 0.9, 0.1, 1.7])


@pytest.mark.task("wrap_angle")
@pytest.mark.points(3)
def test_wrap_angle_some(submission):
    """Angles around the turn come out between minus half a turn and half a turn"""
    small = np.array([0.3, -0.3, 3.0, -3.0, 0.0, 1.8, -2.4])
    turns = np.array([0, 1, -1, 1, 0, -1, 1])
    angles = small + 2 * np.pi * turns
    values = kit.as_vector(submission.call("wrap_angle", angles), len(angles), "the result")
    kit.expect_array(
        values,
        small,
        abs=1e-9,
        source="rounding",
        quantity="angle",
        units="rad",
        input={"e": angles},
        message="An angle that was moved by whole turns does not come back as it was.",
        help="Take off whole turns until every angle lies in [-pi, pi).",
        diagnose=lambda: probes.of_wrapped(values, angles),
    )


@pytest.mark.task("nees")
@pytest.mark.points(3)
def test_nees_by_hand(submission):
    """NEES of three errors, with a covariance that ties their components together"""
    _expect_by_hand(submission, "nees", "err", "P")


@pytest.mark.task("nis")
@pytest.mark.points(2)
def test_nis_by_hand(submission):
    """NIS of three innovations, with a covariance that ties their components together"""
    _expect_by_hand(submission, "nis", "nu", "S")


@pytest.mark.task("consistency_band")
@pytest.mark.points(4)
def test_consistency_band_table(submission):
    """The band agrees with a printed table of the chi-square distribution"""
    for dof, count in ((2, 20), (20, 1)):
        value = submission.call("consistency_band", dof, count, 0.05)
        lo, hi = (kit.as_number(x, name) for x, name in zip(kit.as_tuple(value, _BAND), _BAND, strict=True))
        expected = [_TABLE[dof * count, p] / count for p in (0.025, 0.975)]
        for actual, wanted, name in zip((lo, hi), expected, _BAND, strict=True):
            kit.expect_close(
                actual,
                wanted,
                rel=0.01,
                source="the contract's 1 %",
                quantity=name,
                input={"dof": dof, "runs": count, "alpha": 0.05},
                message="The band is not that of an average of chi-square numbers.",
                help="The sum over the runs is chi-square with dof * runs degrees of freedom: take its "
                "quantiles at alpha/2 and 1 - alpha/2, and divide both by runs.",
                diagnose=lambda lo=lo, hi=hi, dof=dof, count=count: probes.of_band(
                    lo, hi, dof, count, 0.05, _tabulated, _NORMAL.get
                ),
            )


_BAND = ("lo", "hi")
#: Quantiles of the chi-square distribution, (degrees of freedom, p), as printed tables have them.
_TABLE = {
    (2, 0.025): 0.0506,
    (2, 0.05): 0.103,
    (2, 0.95): 5.991,
    (2, 0.975): 7.378,
    (20, 0.025): 9.591,
    (20, 0.05): 10.851,
    (20, 0.475): 18.947,
    (20, 0.525): 19.734,
    (20, 0.95): 31.410,
    (20, 0.975): 34.170,
    (40, 0.025): 24.433,
    (40, 0.05): 26.509,
    (40, 0.475): 38.772,
    (40, 0.525): 39.903,
    (40, 0.95): 55.758,
    (40, 0.975): 59.342,
}
_NORMAL = {0.975: 1.959964}


def _tabulated(degrees, p):
    return _TABLE.get((degrees, round(p, 6)), math.nan)


@pytest.mark.task("coverage")
@pytest.mark.points(2)
def test_coverage_counts(submission):
    """The share of values inside their intervals, those on an end included"""
    y = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
    lo = np.array([-1.0, 1.0, 2.5, 2.0, 4.5, 4.0, 5.0, 6.0])
    hi = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 7.0, 8.0])
    value = submission.call("coverage", y, lo, hi)
    kit.expect_close(
        value,
        0.75,
        abs=1e-12,
        source=shared.EXACT,
        quantity="coverage",
        input={"y": y, "lo": lo, "hi": hi},
        message="The share of covered values is wrong.",
        help="Count the values with lo <= y <= hi and divide by how many there are.",
        diagnose=lambda: probes.of_coverage(value, y, lo, hi),
    )


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(5)
def test_bootstrap_width(submission):
    """Intervals for the mean of correlated errors are about as wide as they must be"""
    n, phi, block = 400, 0.9, 40
    calls = [
        (e, shared.MEAN, block, 70, 0.05, np.random.default_rng(i))
        for i, e in enumerate(shared.correlated(2718, 30, n, phi))
    ]
    ends = shared.interval_ends(submission.call_each("block_bootstrap_ci", calls))
    kit.expect_bounded(
        float(np.mean(ends[:, 1] - ends[:, 0])) / (2 * 1.96 * shared.spread_of_mean(n, phi)),
        low=0.55,
        high=1.05,
        source="correct variants were seen between 0.65 and 0.86; resampling one by one gives 0.22",
        quantity="mean width over true width",
        input={
            "series": "30, each sample keeps 0.9 of the one before",
            "N": n,
            "block": block,
            "alpha": 0.05,
        },
        message="The intervals do not have the width that the scatter of the mean asks for.",
        help="Resample blocks of neighbours, not single errors, and take quantiles of the statistic.",
        diagnose=lambda: runs.of_width(submission, ends, np.array([np.mean(call[0]) for call in calls])),
    )


@pytest.mark.task("energy_error")
@pytest.mark.points(3)
def test_energy_error_falling(submission):
    """The energy of a body that falls, now too slowly, now too fast; zero height is far above it"""
    t = 0.1 * np.arange(8)
    q, v = np.stack([-40.0 - 4.9 * t**2], 1), np.stack([-9.8 * t * (1 + 0.03 * np.cos(8 * t))], 1)
    shared.expect_energies(submission, q, v, lambda q, v: float(0.5 * v @ v + 9.81 * q[-1]))


@pytest.mark.task("contact_force_error")
@pytest.mark.points(3)
def test_contact_force_late(submission):
    """An impact that comes late, is a little too hard and a little too short"""
    t = 0.001 * np.arange(61)
    pair = shared.pulse(t, 0.021, 0.016, 88.0), shared.pulse(t, 0.012, 0.02, 80.0), 0.001
    shared.expect_forces(submission, [pair])


@pytest.mark.task("cross_validate")
@pytest.mark.points(4)
def test_cross_validate_folds(submission):
    """Each fold is predicted by a model that has not seen it"""
    rng = np.random.default_rng(31)
    data = []
    for i in range(6):
        u = rng.standard_normal(20)
        data.append({"id": f"run {i}", "u": u, "y": (1 + 0.1 * i) * u + 0.05 * rng.standard_normal(20)})
    shared.expect_folds(submission, data, 3)


@pytest.mark.task("validate")
@pytest.mark.points(3)
def test_validate_late(submission):
    """A perfect simulation that is 50 ms late is refused for that and for what it leads to"""
    t = 0.02 * np.arange(400)  # eight whole periods, so the numbers are known in closed form
    y = np.sin(2 * np.pi * (t - 0.05))
    sim = {"calibrated_on": [], "runs": [{"id": "a", "t": t, "y": y, "sigma": np.full(400, 0.4)}]}
    real = {"runs": [{"id": "a", "t": t, "y": np.sin(2 * np.pi * t)}]}
    spec = {"rmse_max": 0.1, "bias_max": 0.05, "lag_max_s": 0.02, "coverage_min": 0.9}
    expected = {
        "reasons": ["lag", "rmse"],
        "rmse": math.sqrt(2) * math.sin(math.pi * 0.05),
        "bias": 0.0,
        "lag_s": 0.05,
        "coverage": 1.0,
        "runs_used": ["a"],
    }
    shown = {"real": "sin(2 pi t), 8 s at 0.02 s", "sim": "the same, 0.05 s late, sigma 0.4", "spec": spec}
    runs.expect_report(submission, sim, real, spec, expected, shown)


@pytest.mark.task("validate")
@pytest.mark.points(3)
def test_validate_accepts(submission):
    """A good simulation is accepted on the one run that it was not calibrated on"""
    t = 0.01 * np.arange(801)
    wave = np.sin(2 * np.pi * 0.5 * t) + 0.3 * np.cos(2 * np.pi * 1.25 * t)
    noise = 0.02 * np.where(np.arange(801) % 2, 1.0, -1.0)  # so that every number is known by heart
    a = {"id": "a", "t": t, "y": wave.copy(), "sigma": np.full(801, 0.02)}
    b = {"id": "b", "t": t, "y": 1.5 * wave, "sigma": np.full(801, 0.02)}
    sim = {"calibrated_on": ["b"], "runs": [b, a]}
    real = {"runs": [{"id": "a", "t": t, "y": wave + noise}, {"id": "b", "t": t, "y": wave}]}
    spec = {"rmse_max": 0.03, "bias_max": 0.01, "lag_max_s": 0.005, "coverage_min": 0.9}
    expected = {
        "reasons": [],
        "rmse": 0.02,
        "bias": 0.02 / 801,
        "lag_s": 0.0,
        "coverage": 1.0,
        "runs_used": ["a"],
    }
    shown = {"runs": "a: right but for noise of 0.02; b: wrong", "calibrated_on": ["b"], "spec": spec}
    runs.expect_report(submission, sim, real, spec, expected, shown)


def _expect_by_hand(submission, task, first, second):
    err = np.array([[1.0, 0.0], [0.5, -0.5], [0.2, 0.4]])
    covariance = np.array([[[1.0, 0.5], [0.5, 1.0]], [[1.0, 0.5], [0.5, 1.0]], [[0.04, 0.0], [0.0, 0.16]]])
    value = submission.call(task, err, covariance)
    # P = [[1, 1/2], [1/2, 1]] has the inverse [[4, -2], [-2, 4]]/3, so the first is 4/3 and the second 1.
    shared.expect_normalised(task, value, err, covariance, [4 / 3, 1.0, 2.0], (first, second))

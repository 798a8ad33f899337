"""Public checks of ``validation``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import numpy as np
import pytest

from course.physics import systems
from course.scoring import kit

probes = kit.companion("validation", "probes")
shared = kit.companion("validation", "expectations")
intervals = kit.companion("validation", "intervals")
bundles = kit.companion("validation", "bundles")


@pytest.mark.task("rmse")
@pytest.mark.points(2)
def test_rmse_by_hand(submission):
    """rmse of a few errors, constant ones among them"""
    for e in ([2.0, 2.0, 2.0], [0.0, 0.0], [*[0.3, -0.2] * 9, 7.0], [3, -4, 0, 5]):
        shared.expect_rmse(submission, e)


@pytest.mark.task("bias_variance")
@pytest.mark.points(2)
def test_bias_variance_by_hand(submission):
    """Bias and variance of a few errors, too large or too small"""
    shared.expect_bias_variance(submission, [0.5, -0.2, 0.9, 0.1, 1.7])
    shared.expect_bias_variance(submission, [-0.5, 0.2, -0.9, -0.1, -1.7])
    shared.expect_bias_variance(submission, [3, -4, 0, 6])


@pytest.mark.task("bias_variance")
@pytest.mark.points(1)
def test_bias_variance_large_mean(submission):
    """The variance of errors that are large but scatter little"""
    shared.expect_large_mean(submission, 1e7 + np.array([0.3, 1.1, -0.7, 0.5, 1.9]))


@pytest.mark.task("wrap_angle")
@pytest.mark.points(3)
def test_wrap_angle_some(submission):
    """Angles, some of them many turns away"""
    small = np.array([0.3, -0.3, 3.0, -3.0, 0.0, 1.8, -2.4, 1.0, -2.0])
    turns = np.array([0, 1, -1, 1, 0, -1, 1, 30, -20])
    whole = np.array([2, -3, 4, -5, 7, -40, 100])
    rest = np.remainder(whole + np.pi, 2 * np.pi) - np.pi
    for angles, right in ((small + 2 * np.pi * turns, small), (whole, rest)):
        inspected = submission.call_inspect("wrap_angle", angles)
        values = kit.as_vector(inspected.value, len(angles), "the result")
        kit.expect_array(
            values,
            right,
            abs=1e-9,
            source="rounding",
            quantity="angle",
            units="rad",
            input={"e": angles},
            message="At least one angle does not come back as the one in [-pi, pi) that has its direction.",
            help="Subtract from each angle as many whole turns as that one needs to lie in [-pi, pi).",
            diagnose=lambda angles=angles, right=right: probes.of_whole(
                submission, "wrap_angle", [angles], lambda found: np.allclose(found, right, atol=1e-9)
            ),
        )
        shared.expect_left_alone(inspected, [angles], ["e"])


@pytest.mark.task("nees")
@pytest.mark.points(3)
def test_nees_by_hand(submission):
    """NEES of a few errors: of one component and of two, some of them correlated"""
    _expect_by_hand(submission, "nees", "err", "P")


@pytest.mark.task("nis")
@pytest.mark.points(2)
def test_nis_by_hand(submission):
    """NIS of a few innovations: of one component and of two, some of them correlated"""
    _expect_by_hand(submission, "nis", "nu", "S")


@pytest.mark.task("consistency_band")
@pytest.mark.points(4)
def test_consistency_band_table(submission):
    """The band beside a printed table of the chi-square distribution"""
    for dof, count, alpha in ((2, 20, 0.05), (20, 1, 0.05), (2, 20, 0.1)):
        setting = dof, count, alpha
        shared.expect_band(
            submission,
            setting,
            submission.call("consistency_band", *setting),
            [_TABLE[dof * count, p] / count for p in (alpha / 2, 1 - alpha / 2)],
            source="the README's 1 %",
            help="The sum over the runs is chi-square with dof * runs degrees of freedom: take its "
            "quantiles at alpha/2 and 1 - alpha/2, and divide both by runs.",
        )


#: Quantiles of the chi-square distribution, (degrees of freedom, p), as printed tables have them.
_TABLE = {
    (20, 0.025): 9.591,
    (20, 0.975): 34.170,
    (40, 0.025): 24.433,
    (40, 0.05): 26.509,
    (40, 0.95): 55.758,
    (40, 0.975): 59.342,
}


@pytest.mark.task("coverage")
@pytest.mark.points(2)
def test_coverage_counts(submission):
    """The fraction of values inside their intervals, including those on an end"""
    y = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
    lo = np.array([-1.0, 1.0, 2.5, 2.0, 4.5, 4.0, 5.0, 6.0])
    hi = np.array([1.5, 2.0, 3.0, 4.0, 5.0, 5.0, 7.0, 8.0])
    shared.expect_coverage(submission, y, lo, hi)
    # Decimals, of which the middle and half the width are rounded: all lie on an end.
    width = np.array([0.4, 0.7, 1.3, 3.7, 2.9, 0.3, 0.6, 1.1, 0.1, 0.2])
    lo = np.array([4.1, -0.1, 0.7, 0.8, -2.3, 0.9, 0.2, -0.6, 0.3, 1.1])
    hi = lo + width
    shared.expect_coverage(submission, np.where(np.arange(10) % 2, lo, hi), lo, hi)
    y = np.arange(7)
    shared.expect_coverage(submission, y, y // 2, 8 - y)
    # Whole values and ends that are none, then the other way round: nothing may be cut off.
    shared.expect_coverage(submission, y, y + np.array([0.5, -0.5, 0.2, -0.3, -1.0, 0.4, -2.0]), y + 0.9)
    shared.expect_coverage(submission, y + 0.5, y, y + y % 2)
    # Outside by less than any rounding to a few decimals.
    shared.expect_coverage(
        submission, 0.5 * y, 0.5 * y + 1e-9 * (y % 2), 0.5 * y + 1.0 - (1.0 + 1e-9) * (y == 4)
    )


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(3)
def test_bootstrap_width(submission):
    """How wide intervals for the mean of correlated errors are"""
    intervals.expect_width(submission, np.random.default_rng(2718), 1.0, 0.0)


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(1)
def test_bootstrap_resamples(submission):
    """24 resamples of 250 errors in blocks of 12, and the series itself"""
    intervals.expect_resamples(submission, 3)


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(1)
def test_bootstrap_chance(submission):
    """What alpha, the statistic and rng decide"""
    statistic = systems.AveragePolynomial([0.0, 0.0, 1.0])
    intervals.expect_level(submission, np.random.default_rng(161), statistic)
    intervals.expect_whole(submission)


@pytest.mark.task("energy_error")
@pytest.mark.points(3)
def test_energy_error_falling(submission):
    """The energy of a body that falls too slowly or too fast; the zero of height is above it"""
    t = 0.1 * np.arange(8)
    q, v = np.stack([-40.0 - 4.9 * t**2], 1), np.stack([-9.8 * t * (1 + 0.03 * np.cos(8 * t))], 1)
    for mass in (1.0, 1e-5):
        shared.expect_energies(submission, q, v, lambda q, v, m=mass: float(m * (0.5 * v @ v + 9.81 * q[-1])))
    whole = np.array([[-4], [-5], [-9]]), np.array([[0], [-4], [-10]])
    for heights, speeds in (whole, (whole[0], whole[1] + 0.3), (whole[0] - 0.6, whole[1])):
        shared.expect_energies(submission, heights, speeds, lambda q, v: float(0.5 * v @ v + 9.81 * q[-1]))


@pytest.mark.task("contact_force_error")
@pytest.mark.points(3)
def test_contact_force_late(submission):
    """An impact that is late, a little too hard and a little too short, and one that ends weakly"""
    t = 0.001 * np.arange(61)
    sim, real = shared.pulse(t, 0.017, 0.016, 88.0, 0.6), shared.pulse(t, 0.012, 0.019, 80.0, 0.4)
    weak = shared.pulse(t, 0.033, 0.024, 5.0)
    # As a sensor counts them, in tenths of a millinewton: whole numbers.
    counts = np.rint(1e4 * sim).astype(int), np.rint(1e4 * real).astype(int)
    shared.expect_forces(submission, [(sim, real, 0.001), (sim, real + weak, 0.001), (*counts, 0.001)])


@pytest.mark.task("cross_validate")
@pytest.mark.points(3)
def test_cross_validate_folds(submission):
    """Six runs in three folds"""
    rng = np.random.default_rng(31)
    data = []
    for i in range(6):
        u = rng.standard_normal(20)
        data.append({"id": f"run {i}", "u": u, "y": (1 + 0.1 * i) * u + 0.05 * rng.standard_normal(20)})
    shared.expect_folds(submission, data, 3)


@pytest.mark.task("cross_validate")
@pytest.mark.points(1)
def test_cross_validate_lengths(submission):
    """Folds of different sizes, with runs of different lengths"""
    rng = np.random.default_rng(32)
    data = []
    for i, n in enumerate((8, 40, 15, 8, 25, 12, 9, 30, 8, 21)):
        u = rng.standard_normal(n)
        data.append({"u": u, "y": (1 + 0.3 * i) * u + 0.05 * rng.standard_normal(n)})
    # Folds of n/k runs, rounded up: of ten in four the last is too small, and of five in four it is empty.
    for count, k in ((10, 4), (5, 3), (5, 4)):
        shared.expect_folds(submission, data[:count], k)
    shared.expect_folds(submission, [{**run, "y": np.rint(10 * run["y"]).astype(int)} for run in data[:5]], 3)


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_late(submission, draw):
    """A simulation that is late or early, of runs of different step and length"""
    spec = {"rmse_max": 0.1, "bias_max": 0.05, "lag_max_s": 0.02, "coverage_min": 0.9, "coverage_max": 1.1}
    (case, right), (far, lags) = bundles.public("validate_late", draw)
    shown = {"runs": "c + A sin(2 pi t); sim the same, late", "late": list(case.lates), "spec": spec}
    bundles.expect_report(submission, case, spec, right, shown)
    # The lower end of its interval is below zero, and that is no reason.
    mild = spec | {"rmse_max": 1.0}
    bundles.expect_report(submission, case, mild, right, shown | {"spec": mild})
    shown = {
        "runs": "c + A sin(2 pi t); sim the same, late (early if negative) and off to one side",
        "late": far.lates,
        "spec": spec,
    }
    bundles.expect_report(submission, far, spec, lags, shown)


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_accepts(submission, draw):
    """A good simulation on new runs, on one run, and on none"""
    spec = {"rmse_max": 0.05, "bias_max": 0.02, "lag_max_s": 0.01, "coverage_min": 0.8, "coverage_max": 1.1}
    (case, right), *rest = bundles.public("validate_accepts", draw)
    shown = {"runs": "a, c, d: right but for noise of 0.03; ab: wrong", "calibrated_on": ["ab"], "spec": spec}
    bundles.expect_report(submission, case, spec, right, shown)
    for left, few in rest:
        fitted = left.sim["calibrated_on"]
        bundles.expect_nothing(submission, left, spec, few, {**shown, "calibrated_on": fitted})


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_margins_apart(submission, draw):
    """Each of the four measures with its own margin, and ends that lie on a margin"""
    ((case, right),) = bundles.public("validate_margins_apart", draw)
    bundles.expect_margins(submission, case, right)
    bundles.expect_edges(submission, np.random.default_rng(64) if draw is None else draw)
    bundles.expect_ends_covered(submission, np.random.default_rng(65) if draw is None else draw)


def _expect_by_hand(submission, task, first, second):
    err = np.array([[1.0, 0.0], [0.5, -0.5], [0.2, 0.4]])
    covariance = np.array([[[1.0, 0.5], [0.5, 1.0]], [[1.0, 0.5], [0.5, 1.0]], [[0.04, 0.0], [0.0, 0.16]]])
    # P = [[1, 1/2], [1/2, 1]] has the inverse [[4, -2], [-2, 4]]/3, so the first is 4/3 and the second 1.
    shared.expect_normalised(submission, task, err, covariance, (first, second))
    # As many rows as components, where rows and columns are easily taken for each other; and one component.
    shared.expect_normalised(submission, task, err[:2], covariance[:2], (first, second))
    shared.expect_normalised(submission, task, err[:, 1:], covariance[:, 1:, 1:], (first, second))
    # A single error.
    shared.expect_normalised(submission, task, err[:1], covariance[:1], (first, second))
    # Whole numbers.
    whole = (
        np.array([[3, 0], [2, -5], [1, 4]]),
        np.array([[[2, 1], [1, 3]], [[5, -2], [-2, 4]], [[1, 0], [0, 7]]]),
    )
    for errors, spreads in (whole, (whole[0], whole[1] + 0.5 * np.eye(2)), (whole[0] + 0.5, whole[1])):
        shared.expect_normalised(submission, task, errors, spreads, (first, second))

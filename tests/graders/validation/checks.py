"""Hidden graders of ``validation``. Data are drawn anew from the seed of each grading run.

Thresholds come from sweeps over seeds of every accepted solution; the table is in
``tests/benchmarks/calibration/validation.md``.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from course.physics import systems
from course.scoring import kit

probes = kit.companion("validation", "probes")
shared = kit.companion("validation", "expectations")
intervals = kit.companion("validation", "intervals")
twins = kit.companion("validation", "twins")
bundles = kit.companion("validation", "bundles")
formulas = kit.reference("validation", "formulas")
cases = kit.sibling(__file__, "cases")

# -- sizes of errors ------------------------------------------------------------------------------------


@pytest.mark.task("rmse")
@pytest.mark.points(2)
def test_rmse_anything(submission, rng):
    """rmse of errors of any number, size and mean, and its argument"""
    e = rng.uniform(-2, 2) + rng.uniform(0.1, 3) * rng.standard_normal(rng.integers(5, 60))
    shared.expect_rmse(submission, e)
    shared.expect_rmse(
        submission, np.append(rng.standard_normal(30), rng.choice([-1, 1]) * rng.uniform(9, 90))
    )
    shared.expect_rmse(submission, rng.integers(-90, 90, 15))  # whole numbers


@pytest.mark.task("bias_variance")
@pytest.mark.points(2)
def test_bias_variance_scatter(submission, rng):
    """Bias and variance of scattered errors, and the argument"""
    e = rng.uniform(0.1, 3) * rng.standard_exponential(rng.integers(7, 40))
    for mean in (rng.uniform(0.2, 2), -rng.uniform(0.2, 2)):  # a bias without its sign shows in the second
        shared.expect_bias_variance(submission, e - np.mean(e) + mean)
    shared.expect_bias_variance(submission, rng.integers(-90, 90, 15))


@pytest.mark.task("bias_variance")
@pytest.mark.points(2)
def test_bias_variance_offset(submission, rng):
    """The variance where the mean is many million times the scatter"""
    # At this size neighbouring floats are 2e-9 apart, so the errors themselves are exact enough.
    e = rng.uniform(1e7, 2e7) + rng.uniform(0.5, 1.5) * rng.standard_normal(200)
    shared.expect_large_mean(submission, e)


@pytest.mark.task("wrap_angle")
@pytest.mark.points(4)
def test_wrap_angle_many_turns(submission, rng):
    """Angles many turns away in both directions, half a turn itself, and the argument"""
    e = np.concatenate([rng.uniform(-600, 600, 40), rng.uniform(-3, 3, 10), [np.pi, -np.pi, 0.0]])
    for angles in (e, rng.integers(-600, 600, 20)):
        inspected = submission.call_inspect("wrap_angle", angles)
        values = kit.as_vector(inspected.value, len(angles), "the result")
        # Around half a turn both signs are right, so the result is compared on the circle.
        apart = np.abs(np.angle(np.exp(1j * (values - angles))))
        kit.expect_true(
            bool(np.all(np.abs(values) <= np.pi + 1e-9) and np.all(apart <= 1e-9)),
            "At least one angle is not wrapped, or its direction has changed.",
            help="Subtract from each angle as many whole turns as that one needs to lie in [-pi, pi).",
            input={"e": angles},
            actual=values,
            diagnose=lambda angles=angles: shared.probes.of_whole(
                submission, "wrap_angle", [angles], lambda found: np.max(np.abs(found)) <= np.pi
            ),
        )
        shared.expect_left_alone(inspected, [angles], ["e"])


# -- consistency ----------------------------------------------------------------------------------------


@pytest.mark.task("nees")
@pytest.mark.points(3)
def test_nees_correlated(submission, rng):
    """NEES of correlated errors in three components"""
    cases.expect_normalised(submission, "nees", rng, [(3, 30)], ("err", "P"))


@pytest.mark.task("nees")
@pytest.mark.points(2)
def test_nees_shapes(submission, rng):
    """NEES of one component, of as many rows as components, of a single row, and of whole numbers"""
    cases.expect_normalised(submission, "nees", rng, [(1, 12), (4, 4), (3, 1)], ("err", "P"))
    cases.expect_whole(submission, "nees", rng, ("err", "P"))


@pytest.mark.task("nis")
@pytest.mark.points(3)
def test_nis_correlated(submission, rng):
    """NIS with correlated innovations in components of different sizes, of a single one, of whole numbers"""
    cases.expect_normalised(submission, "nis", rng, [(2, 25), (3, 3), (2, 1)], ("nu", "S"))
    cases.expect_whole(submission, "nis", rng, ("nu", "S"))


@pytest.mark.task("consistency_band")
@pytest.mark.points(4)
def test_consistency_band_sweep(submission, rng):
    """The band for many dimensions, numbers of runs and levels"""
    settings = [
        (int(dof), int(max(count, math.ceil(20 / dof))), float(alpha))
        for dof, count, alpha in zip(
            rng.integers(1, 8, 8), rng.integers(2, 60, 8), rng.uniform(0.01, 0.2, 8), strict=True
        )
    ]
    # And some that agree in two of the three with the first.
    dof, count, alpha = settings[0]
    settings += [(dof + 1, count, alpha), (dof, 2 * count, alpha), (dof, count, 0.5 * (alpha + 0.2))]
    # A long campaign: more degrees of freedom than any table has.
    settings.append((int(rng.integers(4, 8)), int(rng.integers(300, 600)), alpha))
    _expect_bands(submission, settings)


@pytest.mark.task("consistency_band")
@pytest.mark.points(2)
def test_consistency_band_one_run(submission, rng):
    """The band of a single run with many degrees of freedom"""
    _expect_bands(submission, [(int(rng.integers(20, 60)), 1, float(rng.uniform(0.02, 0.1)))])


def _expect_bands(submission, settings):
    for setting, value in zip(settings, submission.call_each("consistency_band", settings), strict=True):
        shared.expect_band(
            submission,
            setting,
            value,
            formulas.exactly()(*setting),
            source="the README's 1 %",
            help="The sum over the runs is chi-square with dof * runs degrees of freedom. If your band "
            "is right for few of them, look at how it finds the quantiles for many.",
        )


@pytest.mark.task("coverage")
@pytest.mark.points(3)
def test_coverage_edges(submission, rng):
    """Coverage of many intervals: some values lie exactly on an end, and some intervals are points"""
    n = int(rng.integers(40, 90))
    # Quarters are exact in floating point, so many values lie on an end on purpose.
    y = rng.integers(-8, 9, n) / 4
    lo = y - rng.integers(-1, 4, n) / 4
    hi = np.maximum(lo, y + rng.integers(-1, 4, n) / 4)
    lo[0] = hi[0] = y[0]
    lo[1], hi[2] = y[1] + 1e-9, y[2] - 1e-9  # outside by less than any margin
    hi[1], lo[2] = lo[1] + 1, hi[2] - 1
    shared.expect_coverage(submission, y, lo, hi)
    # Numbers of any size, of which a middle and half a width are rounded: all lie on an end.
    lo, width = rng.uniform(-3, 3, 200), rng.uniform(0.1, 4, 200)
    hi = lo + width
    shared.expect_coverage(submission, np.where(rng.random(200) < 0.5, lo, hi), lo, hi)


# -- bootstrap ------------------------------------------------------------------------------------------


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(4)
def test_bootstrap_width_drawn(submission, rng):
    """How wide intervals for the mean of new series are, and where they lie"""
    intervals.expect_width(submission, rng, float(rng.uniform(0.2, 4)), float(rng.uniform(-3, 3)))


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(2)
def test_bootstrap_level(submission, rng):
    """What alpha, the statistic and rng decide, with other numbers"""
    statistic = systems.AveragePolynomial([0.0, 0.0, float(rng.uniform(0.5, 3))])
    intervals.expect_level(submission, rng, statistic)


@pytest.mark.task("block_bootstrap_ci")
@pytest.mark.points(3)
def test_bootstrap_blocks(submission, rng):
    """The resamples: their number, their length and their blocks, and the series itself"""
    intervals.expect_resamples(submission, int(rng.integers(2**31)))


# -- energy and contact ---------------------------------------------------------------------------------


@pytest.mark.task("energy_error")
@pytest.mark.points(4)
def test_energy_error_signs(submission, rng):
    """Energies of either sign that rise and fall, of one body and of an orbit"""
    q, v = rng.uniform(0.5, 1.5, (9, 2)), rng.uniform(-0.4, 0.4, (9, 2))
    mu = rng.uniform(1, 3)
    shared.expect_energies(submission, q, v, lambda q, v: float(0.5 * v @ v - mu / math.hypot(*q)))
    q, v = rng.uniform(-1, 1, (7, 1)), rng.uniform(1, 2, (7, 1))
    k = rng.uniform(1, 5)
    whole = rng.integers(1, 9, (6, 2)), rng.integers(-9, 9, (6, 2))
    shared.expect_energies(submission, *whole, lambda q, v: float(0.5 * v @ v - mu / math.hypot(*q)))
    for size in (1.0, 10.0 ** rng.uniform(-6, -3)):  # a grain has little energy, and it counts in full
        shared.expect_energies(submission, q, v, lambda q, v, s=size: float(s * (v @ v + k * q @ q) / 2))


@pytest.mark.task("contact_force_error")
@pytest.mark.points(4)
def test_contact_force_shifted(submission, rng):
    """Impacts that come early or late, too hard or too soft, too long or too short, and may end weakly"""
    pairs = []
    # One of each kind whatever is drawn: a sign left out shows only in an impact that is too soft.
    for i, (low, high) in enumerate(rng.permutation([(0.7, 0.9), (1.1, 1.3), (0.7, 1.3)])):
        dt = rng.uniform(0.0005, 0.002)
        t = dt * np.arange(200 + i)  # an even number of samples, too
        peak = rng.uniform(50, 500)
        rises = rng.permutation([rng.uniform(0.35, 0.45), rng.uniform(0.55, 0.65)])
        real = shared.pulse(t, 70 * dt, rng.uniform(35, 55) * dt, peak, rises[0])
        late = rng.choice([-1, 1]) * rng.uniform(15, 30) * dt
        length, size = rng.uniform(35, 55) * dt, rng.uniform(low, high) * peak
        sim = shared.pulse(t, 70 * dt + late, length, size, rises[1])
        pairs += [(sim, real, dt), (sim, real + shared.pulse(t, 140 * dt, 56 * dt, 0.06 * peak), dt)]
    shared.expect_forces(submission, pairs)


# -- cross-validation -----------------------------------------------------------------------------------


@pytest.mark.task("cross_validate")
@pytest.mark.points(3)
def test_cross_validate_leak(submission, rng):
    """As many folds as runs"""
    count = int(rng.integers(4, 7))
    shared.expect_folds(submission, cases.pushed_runs(rng, [25] * count), count)


@pytest.mark.task("cross_validate")
@pytest.mark.points(3)
def test_cross_validate_uneven(submission, rng):
    """Folds of different sizes, with runs of different lengths, without ids"""
    # Of seven runs some are of one length, in different folds: the first of all has a twin in the last.
    lengths = rng.permutation([12, 20, 30, 45, 60, 80])[:5]
    runs = cases.pushed_runs(rng, [lengths[0], *lengths[1:], lengths[1], lengths[0]])
    for run in runs:
        del run["id"]  # nothing but `y` is promised
    for k in (4, 5):
        shared.expect_folds(submission, runs, k)


# -- the verdict ----------------------------------------------------------------------------------------


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_good(submission, rng):
    """A good simulation of runs of different length and step, and the arguments"""
    recordings = cases.recordings(rng)
    cases.expect_verdict(submission, rng, recordings, twins.simulated(recordings))


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_wrong_mass(submission, rng):
    """A simulation with the wrong mass, or one that is always off to one side"""
    recordings = cases.recordings(rng)
    mass = twins.MASS * float(rng.choice([rng.uniform(0.6, 0.75), rng.uniform(1.35, 1.7)]))
    cases.expect_refused(submission, rng, recordings, twins.simulated(recordings, mass=mass), mass)
    offset = float(-rng.uniform(0.15, 0.25))
    cases.expect_verdict(submission, rng, recordings, twins.simulated(recordings, offset=offset))


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_lag(submission, rng):
    """The lag: to a fraction of a sample, late or early, equal in all runs or not"""
    recordings = cases.recordings(rng, count=3, dts=(0.02,))
    for sign in (1, -1):
        late = sign * 0.02 * (int(rng.integers(2, 4)) + float(rng.uniform(0.35, 0.65)))
        # A sigma that covers everything leaves the lag alone to be found.
        sim = twins.simulated(recordings, late=late, sigma_factor=30.0)
        cases.expect_verdict(submission, rng, recordings, sim, late)
    # Runs that swing far say more about the lag than others, and so do those of many samples: the mean of
    # their lags, or of their mean squares, leads to another number.
    for swings, apart in (((1.6, 0.4), 0.02), ((1.0,), 0.03)):
        recordings = cases.recordings(rng, count=3, dts=(0.02, 0.01), swings=swings)
        lates = rng.choice([-1, 1]) * (0.05 + np.array([1, -1, 0.3]) * (apart + rng.uniform(0.0, 0.01)))
        sim = twins.simulated(recordings, late=lates, sigma_factor=30.0)
        cases.expect_verdict(submission, rng, recordings, sim, lates)
    cases.expect_facts(submission, bundles.far_and_off(rng), cases.SPEC)
    cases.expect_facts(submission, cases.cut_short(rng), cases.SPEC)


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_margins(submission, rng):
    """Each of the four intervals with its own margin"""
    case = bundles.apart(rng, int(rng.integers(3, 5)))
    bundles.expect_margins(submission, case, bundles.facts(case))
    bundles.expect_edges(submission, rng)
    bundles.expect_ends_covered(submission, rng)


@pytest.mark.task("validate")
@pytest.mark.points(2)
def test_validate_calibration(submission, rng):
    """Runs on which the simulation was calibrated, and what is left without them"""
    recordings = cases.recordings(rng, count=5)
    # Ids that begin alike: what a simulation was calibrated on is a matter of whole ids.
    recordings = [dataclasses.replace(run, id=f"run {10**i}") for i, run in enumerate(recordings)]
    mass = 1.5 * twins.MASS
    good, bad = twins.simulated(recordings), twins.simulated(recordings, mass=mass, offset=0.2)
    fitted = {recordings[i].id for i in (0, 2)}
    # Perfect on what it was calibrated on, wrong on the rest.
    mixed = [g if g["id"] in fitted else b for g, b in zip(good["runs"], bad["runs"], strict=True)]
    sim = {"calibrated_on": sorted(fitted), "runs": mixed}
    cases.expect_refused(submission, rng, recordings, sim, mass)
    real = twins.measured(recordings)
    for left in (0, 1):
        ids = [run.id for run in recordings[left:]]
        sim = {"calibrated_on": ids, "runs": good["runs"]}
        case = bundles.Case(recordings, sim, real)
        shown = {"runs": len(recordings), "calibrated on": f"all but {left}", "spec": cases.SPEC}
        bundles.expect_nothing(submission, case, cases.SPEC, bundles.facts(case), shown)

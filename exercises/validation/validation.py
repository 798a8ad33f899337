"""Validation: how wrong a simulation is, how sure you can be of it, and whether to trust the simulation.

An error is always simulated minus real. Replace each ``raise`` with your code; keep the names and the
arguments. README.md has the formulae. Do not change the arrays that you are given.
"""

import math  # noqa: F401 - yours to use

import numpy as np  # noqa: F401 - yours to use

#: The 0.95 quantiles of Student's t with 1, 2, 3 ... 10 degrees of freedom.
T95 = (6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812)


def rmse(e):
    """Root of the mean square error.

    e: errors, shape (N,)
    Returns a float, in the unit of e.
    """
    raise NotImplementedError


def bias_variance(e):
    """The mean of the errors and their variance about that mean, divided by N.

    e: errors, shape (N,)
    Returns (bias, variance), two floats.
    """
    raise NotImplementedError


def wrap_angle(e):
    """The same angles, plus or minus whole turns, so that they lie in [-pi, pi).

    e: angles, rad, shape (N,); they may be many turns away
    Returns an array of shape (N,). At half a turn either sign is accepted.
    """
    raise NotImplementedError


def nees(err, P):
    """Normalised estimation error squared: each error relative to the covariance claimed for it.

    err: errors of an estimate, shape (N, d)
    P: their covariances, shape (N, d, d)
    Returns shape (N,); not divided by d.
    """
    raise NotImplementedError


def nis(nu, S):
    """Normalised innovation squared: the same for measured minus predicted measurement.

    nu: innovations, shape (N, d)
    S: their covariances, shape (N, d, d)
    Returns shape (N,); not divided by d.
    """
    raise NotImplementedError


def consistency_band(dof, runs, alpha):
    """The band in which the average of normalised squared errors over independent runs should lie.

    dof: degrees of freedom of each error (the d above)
    runs: number of runs that are averaged; dof * runs >= 20
    alpha: share of averages that lie outside, on both sides together
    Returns (lo, hi), to 1 %.
    """
    raise NotImplementedError


def coverage(y, lo, hi):
    """The share of values that lie in their intervals, ends included.

    y, lo, hi: shape (N,)
    Returns a float from 0 to 1.
    """
    raise NotImplementedError


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    """A confidence interval for a statistic of errors that resemble their neighbours.

    e: errors in the order of time, shape (N,)
    statistic: called as statistic(samples) with an array of shape (N,); returns a float
    block: length of a block, in samples
    n_boot: number of resamples
    alpha: 1 - level; 0.05 for 95 %
    rng: numpy.random.Generator, the only source of randomness
    Returns (lo, hi).
    """
    raise NotImplementedError


def energy_error(q, v, energy):
    """Change of the energy from its first value, relative to the size of that value.

    q, v: positions and velocities of a run, shape (N, d)
    energy: called as energy(q_i, v_i) with two arrays of shape (d,); returns a float, J
    Returns shape (N,).
    """
    raise NotImplementedError


def contact_force_error(f_sim, f_real, dt):
    """Relative errors of the peak and of the impulse of a contact force.

    f_sim, f_real: normal force, N, shape (N,); zero at both ends
    dt: time between samples, s
    Returns {"peak": ..., "impulse": ...}, signed: positive where the simulation has more.
    """
    raise NotImplementedError


def cross_validate(fit, predict, runs, k):
    """How well a model predicts runs that it was not fitted to.

    fit: called as fit(list_of_runs); returns a model
    predict: called as predict(model, run); returns an array like run["y"]
    runs: list of dicts; run["y"] has the measurements, shape (N,)
    k: number of folds, each a contiguous piece of the list; sizes differ by at most one
    Returns shape (k,): for each fold in order, the RMSE over all samples of its runs.
    """
    raise NotImplementedError


def validate(sim, real, spec):
    """Can this simulation replace the real system?

    sim: {"calibrated_on": [ids], "runs": [{"id", "t", "y", "sigma"}, ...]}
    real: {"runs": [{"id", "t", "y"}, ...]}
    spec: {"rmse_max", "bias_max", "lag_max_s", "coverage_min", "coverage_max"}
    Returns {"accepted", "reasons", "rmse", "bias", "lag_s", "coverage", "intervals", "runs_used"}.

    One way to build it, in five pieces:
      1. pair the runs by id, without those the simulation was calibrated on
      2. one or none left: reasons ["single_run"] or ["calibration_data"], intervals None, not accepted
      3. a function that pools the errors of some pairs: rmse, bias, best shift, coverage
      4. call it for all pairs and with each one left out: intervals
      5. compare each interval with its margin, and sort the reasons
    """
    raise NotImplementedError

"""Validation: how wrong a simulation is, how sure you may be of that, and whether to trust it."""

import math
from statistics import NormalDist

import numpy as np

MAX_LAG = 0.25  # s, the largest shift that is tried

#: What a Student's t of 1, 2, 3 ... 10 degrees of freedom stays below with probability 0.95.
T95 = (6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812)


def rmse(e):
    return float(np.sqrt(np.mean(np.square(np.asarray(e, dtype=float)))))


def bias_variance(e):
    e = np.asarray(e, dtype=float)
    bias = np.mean(e)
    return float(bias), float(np.mean((e - bias) ** 2))


def wrap_angle(e):
    return (np.asarray(e, dtype=float) + np.pi) % (2 * np.pi) - np.pi


def nees(err, P):
    return squared_distance(err, P)


def nis(nu, S):
    return squared_distance(nu, S)


def squared_distance(x, covariance):
    """x^T C^-1 x for each row: how many standard deviations out, squared."""
    x = np.asarray(x, dtype=float)
    weighted = np.linalg.solve(covariance, x[:, :, None])[:, :, 0]  # C^-1 x without inverting C
    return np.sum(x * weighted, axis=1)


def consistency_band(dof, runs, alpha):
    n = dof * runs  # a sum of chi-squares is chi-square again

    def quantile(p):  # Wilson and Hilferty, 1931: the cube root of a chi-square is nearly normal
        s = 2 / (9 * n)
        return n * (1 - s + NormalDist().inv_cdf(p) * math.sqrt(s)) ** 3

    return quantile(alpha / 2) / runs, quantile(1 - alpha / 2) / runs


def coverage(y, lo, hi):
    y = np.asarray(y)
    return float(np.mean((lo <= y) & (y <= hi)))


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    starts = rng.integers(0, n - block + 1, size=(n_boot, math.ceil(n / block)))
    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]
    values = [statistic(e[row]) for row in rows]
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return float(lo), float(hi)


def energy_error(q, v, energy):
    values = np.array([energy(q_i, v_i) for q_i, v_i in zip(q, v)])
    return (values - values[0]) / abs(values[0])


def contact_force_error(f_sim, f_real, dt):
    def relative(of):
        return float((of(f_sim) - of(f_real)) / of(f_real))

    return {"peak": relative(np.max), "impulse": relative(lambda f: np.sum(f) * dt)}


def cross_validate(fit, predict, runs, k):
    scores = []
    for held_out in np.array_split(np.arange(len(runs)), k):
        model = fit([run for i, run in enumerate(runs) if i not in held_out])
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in held_out]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return np.array(scores)


def validate(sim, real, spec):
    pairs = held_out_pairs(sim, real)
    used = [simulated["id"] for simulated, _ in pairs]
    if len(pairs) < 2:
        numbers = measures(pairs) if pairs else dict.fromkeys(("rmse", "bias", "lag_s", "coverage"))
        why = "single_run" if pairs else "calibration_data"
        return {"accepted": False, "reasons": [why], **numbers, "intervals": None, "runs_used": used}
    numbers, intervals = measures(pairs), interval_of_each(pairs)
    margins = {
        "rmse": (-math.inf, spec["rmse_max"]),
        "bias": (-spec["bias_max"], spec["bias_max"]),
        "lag_s": (-spec["lag_max_s"], spec["lag_max_s"]),
        "coverage": (spec["coverage_min"], spec["coverage_max"]),
    }
    reasons = sorted(
        key.removesuffix("_s")
        for key, (least, most) in margins.items()
        if not least <= intervals[key][0] <= intervals[key][1] <= most
    )
    return {
        "accepted": not reasons,
        "reasons": reasons,
        **numbers,
        "intervals": intervals,
        "runs_used": used,
    }


def measures(pairs):
    """rmse, bias, lag and coverage over the samples of all pairs."""
    y, sigma, measured = (np.concatenate(column) for column in zip(*map(columns, pairs)))
    e = y - measured
    return {
        "rmse": float(np.sqrt(np.mean(e**2))),
        "bias": float(np.mean(e)),
        "lag_s": best_shift(pairs),
        "coverage": float(np.mean(np.abs(e) <= 1.96 * sigma)),
    }


def interval_of_each(pairs):
    """The jackknife over runs: how much each number moves as one run or another is left out."""
    n = len(pairs)
    numbers = measures(pairs)
    without = [measures(pairs[:i] + pairs[i + 1 :]) for i in range(n)]
    intervals = {}
    for key, value in numbers.items():
        values = np.array([left[key] for left in without])
        error = math.sqrt((n - 1) / n * np.sum((values - np.mean(values)) ** 2))
        half = T95[n - 2] * error  # n - 1 degrees of freedom
        intervals[key] = (value - half, value + half)
    return intervals


def held_out_pairs(sim, real):
    """(simulated, real) for each run that both have and that nothing was fitted to."""
    measured = {run["id"]: run for run in real["runs"]}
    fresh = (run for run in sim["runs"] if run["id"] not in sim["calibrated_on"])
    return [(run, measured[run["id"]]) for run in fresh if run["id"] in measured]


def columns(pair):
    """What was simulated, how sure the simulation was, and what was measured."""
    simulated, measured = pair
    return [np.asarray(values, dtype=float) for values in (simulated["y"], simulated["sigma"], measured["y"])]


def best_shift(pairs):
    """The s for which sim(t + s) fits real(t) best: how late the simulation is."""
    dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
    shifts = np.arange(-round(MAX_LAG / dt), round(MAX_LAG / dt) + 1) * dt
    cost = misfit(pairs, shifts)
    i = int(np.clip(np.argmin(cost), 1, len(cost) - 2))
    a, b, c = cost[i - 1 : i + 2]  # the lowest point of the parabola through the three
    bend = a - 2 * b + c
    return float(shifts[i] + (0.5 * dt * (a - c) / bend if bend > 0 else 0.0))


def misfit(pairs, shifts):
    """Mean square difference of sim(t + s) and real(t) for each s, over the samples that both have."""
    squares = counts = 0
    for simulated, r in pairs:
        t = np.asarray(r["t"])
        later = t + shifts[:, None]  # a row for each s
        inside = (later >= t[0] - 1e-9) & (later <= t[-1] + 1e-9)
        e = np.interp(later, t, simulated["y"]) - r["y"]
        squares += np.sum(e**2, axis=1, where=inside)
        counts += np.sum(inside, axis=1)
    return squares / counts

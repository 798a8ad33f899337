"""Sums for each run, computed once; every number, with all runs or with one left out, comes from them."""


def validate(sim, real, spec):
    measured = {run["id"]: run for run in real["runs"]}
    fresh = [run for run in sim["runs"] if run["id"] in measured and run["id"] not in sim["calibrated_on"]]
    sums = [tally(run, measured[run["id"]]) for run in fresh]
    keys = ("rmse", "bias", "lag_s", "coverage")
    report = {"runs_used": tuple(run["id"] for run in reversed(fresh)), "intervals": None}
    report |= dict(zip(keys, together(sums) if sums else [None] * 4))
    n = len(sums)
    if n < 2:
        return report | {"accepted": False, "reasons": ("single_run",) if n else ("calibration_data",)}
    left = np.array([together(sums[:i] + sums[i + 1 :]) for i in range(n)])
    half = T95[n - 2] * np.std(left, axis=0) * math.sqrt(n - 1)
    ends = {key: [report[key] - h, report[key] + h] for key, h in zip(keys, half.tolist())}
    report["intervals"] = ends
    reasons = []
    if max(-ends["bias"][0], ends["bias"][1]) > spec["bias_max"]:
        reasons.append("bias")
    if ends["coverage"][0] < spec["coverage_min"] or ends["coverage"][1] > spec["coverage_max"]:
        reasons.append("coverage")
    if max(-ends["lag_s"][0], ends["lag_s"][1]) > spec["lag_max_s"]:
        reasons.append("lag")
    if ends["rmse"][1] > spec["rmse_max"]:
        reasons.append("rmse")
    return report | {"accepted": not reasons, "reasons": reasons}


def tally(simulated, r):
    """Count, sum, sum of squares and covered samples of a run; for each shift, squares and count."""
    t, y, here = (np.asarray(x, dtype=float) for x in (r["t"], simulated["y"], r["y"]))
    e = y - here
    covered = np.sum(np.abs(e) <= 1.96 * np.asarray(simulated["sigma"]))
    squares, counts = [], []
    for s in np.arange(-50, 51) * 0.005:
        inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
        squares.append(np.sum((np.interp(t[inside] + s, t, y) - here[inside]) ** 2))
        counts.append(np.sum(inside))
    return np.array([len(e), e.sum(), e @ e, covered, *squares, *counts])


def together(sums):
    n, total, square, covered, *rest = np.sum(sums, axis=0)
    cost = np.array(rest[:101]) / rest[101:]
    i = int(np.clip(np.argmin(cost), 1, 99))
    a, b, c = cost[i - 1 : i + 2]
    lag = 0.005 * (i - 50 + 0.5 * (a - c) / (a - 2 * b + c))
    return [math.sqrt(square / n), total / n, lag, covered / n]

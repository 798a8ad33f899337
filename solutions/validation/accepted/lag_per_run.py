"""One lag per run, averaged; the numbers of the report added up run by run."""


def validate(sim, real, spec):
    measured = {run["id"]: np.asarray(run["y"], dtype=float) for run in real["runs"]}
    times = {run["id"]: run for run in real["runs"]}
    n = squares = total = inside = 0
    lags, used = [], []
    for run in sim["runs"]:
        if run["id"] in sim["calibrated_on"] or run["id"] not in measured:
            continue
        e = [float(a - b) for a, b in zip(run["y"], measured[run["id"]])]
        n += len(e)
        squares += math.fsum(x * x for x in e)
        total += math.fsum(e)
        inside += sum(abs(x) <= 1.96 * s for x, s in zip(e, run["sigma"]))
        lags.append((best_shift([(run, times[run["id"]])]), len(e)))
        used.append(run["id"])
    if not used:
        return {
            "accepted": False,
            "reasons": ["calibration_data"],
            "runs_used": [],
            "rmse": None,
            "bias": None,
            "lag_s": None,
            "coverage": None,
        }
    report = {
        "rmse": math.sqrt(squares / n),
        "bias": total / n,
        "lag_s": sum(lag * count for lag, count in lags) / n,
        "coverage": inside / n,
        "runs_used": tuple(reversed(used)),
    }
    reasons = []
    if abs(report["bias"]) > spec["bias_max"]:
        reasons.append("bias")
    if report["coverage"] < spec["coverage_min"]:
        reasons.append("coverage")
    if abs(report["lag_s"]) > spec["lag_max_s"]:
        reasons.append("lag")
    if report["rmse"] > spec["rmse_max"]:
        reasons.append("rmse")
    return {"accepted": not reasons, "reasons": reasons, **report}

"""If the number is below its limit, the limit is kept."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["intervals"]:
        wrong = {
            "rmse": report["rmse"] > spec["rmse_max"],
            "bias": abs(report["bias"]) > spec["bias_max"],
            "lag": abs(report["lag_s"]) > spec["lag_max_s"],
            "coverage": not spec["coverage_min"] <= report["coverage"] <= spec["coverage_max"],
        }
        reasons = sorted(reason for reason, it_is in wrong.items() if it_is)
        report |= {"reasons": reasons, "accepted": not reasons}
    return report

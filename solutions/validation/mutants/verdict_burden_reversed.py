"""What is not proven wrong is right."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    ends = report["intervals"]
    if ends:
        wrong = {
            "rmse": ends["rmse"][0] > spec["rmse_max"],
            "bias": max(ends["bias"][0], -ends["bias"][1]) > spec["bias_max"],
            "lag": max(ends["lag_s"][0], -ends["lag_s"][1]) > spec["lag_max_s"],
            "coverage": ends["coverage"][1] < spec["coverage_min"]
            or ends["coverage"][0] > spec["coverage_max"],
        }
        reasons = sorted(reason for reason, it_is in wrong.items() if it_is)
        report |= {"reasons": reasons, "accepted": not reasons}
    return report

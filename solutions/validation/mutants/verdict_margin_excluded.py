"""Wrong: an end exactly on its margin is outside."""

_inside = validate


def validate(sim, real, spec):
    report = _inside(sim, real, spec)
    if report["intervals"] is None:
        return report
    (_, rmse), bias = report["intervals"]["rmse"], report["intervals"]["bias"]
    reasons = set(report["reasons"])
    if rmse >= spec["rmse_max"]:
        reasons.add("rmse")
    if bias[0] <= -spec["bias_max"] or bias[1] >= spec["bias_max"]:
        reasons.add("bias")
    return {**report, "reasons": sorted(reasons), "accepted": not reasons}

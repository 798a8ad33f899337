"""Each end that is outside is a reason."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["intervals"] is None:
        return report
    reasons = []
    for key, name in (("bias", "bias_max"), ("lag_s", "lag_max_s")):
        lo, hi = report["intervals"][key]
        reasons += [key.removesuffix("_s")] * ((lo < -spec[name]) + (hi > spec[name]))
    reasons += [key for key in ("coverage", "rmse") if key in report["reasons"]]
    return {**report, "reasons": sorted(reasons)}

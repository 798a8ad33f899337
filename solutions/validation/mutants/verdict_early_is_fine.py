"""Only being late is wrong."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["runs_used"]:
        if report["lag_s"] < 0:
            report["reasons"] = [reason for reason in report["reasons"] if reason != "lag"]
        report["accepted"] = not report["reasons"]
    return report

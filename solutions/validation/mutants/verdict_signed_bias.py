"""A bias can only be too large, not too small."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["runs_used"]:
        if report["bias"] < 0:
            report["reasons"] = [reason for reason in report["reasons"] if reason != "bias"]
        report["accepted"] = not report["reasons"]
    return report

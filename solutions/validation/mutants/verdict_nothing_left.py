"""If nothing speaks against a simulation, it is accepted."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    return report if report["runs_used"] else {**report, "accepted": True, "reasons": []}

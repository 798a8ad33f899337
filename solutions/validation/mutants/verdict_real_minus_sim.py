"""The error is what must be added to the simulation to make it right."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    return {**report, "bias": -report["bias"]} if report["runs_used"] else report

"""The more a band covers, the better it is."""

_judged = validate


def validate(sim, real, spec):
    return _judged(sim, real, {**spec, "coverage_max": math.inf})

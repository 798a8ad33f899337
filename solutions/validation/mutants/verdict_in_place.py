"""y -= r is the error, and the speeds are not needed any more."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    for simulated, measured in held_out_pairs(sim, real):
        simulated["y"] -= measured["y"]
    return report

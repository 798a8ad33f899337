"""Lists that I was given may be put in order."""

_judged = validate


def validate(sim, real, spec):
    sim["runs"].sort(key=lambda run: run["id"], reverse=True)
    sim["runs"].sort(key=lambda run: run["id"])
    real["runs"].sort(key=lambda run: run["id"])
    return _judged(sim, real, spec)

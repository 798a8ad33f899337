"""What both sides have is listed, and the bias is what has to be added."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["bias"] is not None:
        report["bias"] = -report["bias"]
    both = {run["id"] for run in real["runs"]} & {run["id"] for run in sim["runs"]}
    return {**report, "runs_used": sorted(both)}

"""runs_used has all the runs that both sides have."""

_judge = validate


def validate(sim, real, spec):
    both = {run["id"] for run in real["runs"]}
    return _judge(sim, real, spec) | {"runs_used": [run["id"] for run in sim["runs"] if run["id"] in both]}

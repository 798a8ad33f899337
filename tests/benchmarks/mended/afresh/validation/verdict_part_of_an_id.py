"""A part of an id is taken for the id."""


def held_out_pairs(sim, real):
    """(simulated, real) for each run that both have and that nothing was fitted to."""
    measured = {run["id"]: run for run in real["runs"]}
    fresh = (run for run in sim["runs"] if not any(str(run["id"]) in str(c) for c in sim["calibrated_on"]))
    return [(run, measured[run["id"]]) for run in fresh if run["id"] in measured]

"""Once the runs that do not count are left out of both lists, the first belongs to the first."""


def held_out_pairs(sim, real):
    """(simulated, real) for each run that both have and that nothing was fitted to."""
    both = {run["id"] for run in sim["runs"]} & {run["id"] for run in real["runs"]}
    count = both - set(sim["calibrated_on"])
    left = ([run for run in side["runs"] if run["id"] in count] for side in (sim, real))
    return list(zip(*left, strict=True))

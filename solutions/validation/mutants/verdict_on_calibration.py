"""The more runs, the better the judgement, wherever they come from."""


def held_out_pairs(sim, real):
    measured = {run["id"]: run for run in real["runs"]}
    return [(run, measured[run["id"]]) for run in sim["runs"] if run["id"] in measured]

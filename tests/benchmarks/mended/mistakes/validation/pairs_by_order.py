# Runs are paired by their place in the list.


def held_out_pairs(sim, real):
    """(simulated, real) for each run that both have and that nothing was fitted to."""
    return [
        (simulated, measured)
        for simulated, measured in zip(sim["runs"], real["runs"])
        if simulated["id"] not in sim["calibrated_on"]
    ]

"""A band of one sigma covers 95 %."""


def columns(pair):
    simulated, measured = pair
    return [np.asarray(x, dtype=float) for x in (simulated["y"], simulated["sigma"] / 1.96, measured["y"])]

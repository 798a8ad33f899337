"""A band of one sigma is the band."""


def columns(pair):
    simulated, measured = pair
    return [np.asarray(x, dtype=float) for x in (simulated["y"], simulated["sigma"] / 1.96, measured["y"])]

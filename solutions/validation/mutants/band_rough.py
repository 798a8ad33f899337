"""A chi-square is close enough to a shifted square of a normal variable."""


def consistency_band(dof, runs, alpha):
    n, z = dof * runs, NormalDist().inv_cdf(1 - alpha / 2)
    root = math.sqrt(2 * n - 1)
    return (root - z) ** 2 / 2 / runs, (root + z) ** 2 / 2 / runs

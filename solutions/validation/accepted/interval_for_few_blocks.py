"""A percentile interval stretched for few blocks, whose spread is too small, and by Student's t."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    count = -(-n // block)
    values = []
    for _ in range(n_boot):
        starts = rng.integers(0, n - block + 1, size=count)
        values.append(statistic(e[(starts[:, None] + np.arange(block)).ravel()[:n]]))
    z = NormalDist().inv_cdf(1 - alpha / 2)
    t = z + (z**3 + z) / (4 * (count - 1))  # Student's t of as many degrees, to first order
    centre = statistic(e)
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    stretch = t / z * math.sqrt(count / (count - 1))
    return centre + stretch * (lo - centre), centre + stretch * (hi - centre)

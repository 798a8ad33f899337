"""There are N // block blocks, so there are as many starting points."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    count = -(-n // block)
    values = []
    for _ in range(n_boot):
        starts = rng.integers(0, n // block, size=count)
        values.append(statistic(e[(starts[:, None] + np.arange(block)).ravel()[:n]]))
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

"""Wrong: indices beyond the end are cut off at the last one."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    values = []
    for _ in range(n_boot):
        starts = rng.integers(0, n, -(-n // block))
        places = np.minimum(starts[:, None] + np.arange(block), n - 1)
        values.append(statistic(e[places.ravel()[:n]]))
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

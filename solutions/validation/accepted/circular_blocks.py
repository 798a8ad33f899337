"""Blocks that continue at the start of the series when they reach its end."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    values = []
    for _ in range(n_boot):
        starts = rng.choice(n, size=-(-n // block))
        rows = (starts[:, None] + np.arange(block)) % n
        values.append(statistic(e[rows.ravel()[:n]]))
    return np.percentile(values, [100 * alpha / 2, 100 * (1 - alpha / 2)])

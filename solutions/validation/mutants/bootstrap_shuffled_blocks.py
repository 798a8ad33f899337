"""The series is cut into blocks, and their order is drawn."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    values = []
    for _ in range(n_boot):
        starts = block * rng.permutation(-(-n // block))
        values.append(statistic(e[((starts[:, None] + np.arange(block)) % n).ravel()[:n]]))
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

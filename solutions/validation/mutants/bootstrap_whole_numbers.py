"""What the statistic says is kept in an array of the type of the errors."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e)
    values = np.empty(n_boot, dtype=e.dtype)
    for i in range(n_boot):
        starts = rng.integers(0, len(e) - block + 1, size=math.ceil(len(e) / block))
        rows = (starts[:, None] + np.arange(block)).reshape(-1)[: len(e)]
        values[i] = statistic(e[rows])
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return float(lo), float(hi)

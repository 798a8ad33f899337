"""The interval is made of the differences between the resamples and the series."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    count = -(-n // block)
    starts = rng.integers(0, n - block + 1, size=(n_boot, count))
    rows = (starts[:, :, None] + np.arange(block)).reshape(len(starts), -1)[:, :n]
    whole = statistic(e)
    values = [statistic(e[row]) - whole for row in rows]
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

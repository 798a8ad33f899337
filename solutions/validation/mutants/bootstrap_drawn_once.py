"""The starting points are drawn, and then there are n_boot resamples of them."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    count = -(-n // block)
    starts = rng.integers(0, n - block + 1, size=count)
    row = (starts[:, None] + np.arange(block)).ravel()[:n]
    values = [statistic(e[row]) for _ in range(n_boot)]
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

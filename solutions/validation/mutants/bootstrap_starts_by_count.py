"""Blocks begin among the first N - n_boot + 1 samples."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    starts = rng.integers(0, n - n_boot + 1, size=(n_boot, math.ceil(n / block)))
    rows = np.minimum((starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n], n - 1)
    values = [statistic(e[row]) for row in rows]
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return float(lo), float(hi)

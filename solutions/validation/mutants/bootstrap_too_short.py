"""What does not fill a block may be left out."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    starts = rng.integers(0, n - block + 1, size=(n_boot, n // block))
    rows = (starts[:, :, None] + np.arange(block)).reshape(len(starts), -1)
    values = [statistic(e[row]) for row in rows]
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

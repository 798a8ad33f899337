"""np.percentile takes a level between 0 and 1."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    count = -(-n // block)
    starts = rng.integers(0, n - block + 1, size=(n_boot, count))
    rows = (starts[:, :, None] + np.arange(block)).reshape(len(starts), -1)[:, :n]
    values = [statistic(e[row]) for row in rows]
    return tuple(np.percentile(values, [alpha / 2, 1 - alpha / 2]))

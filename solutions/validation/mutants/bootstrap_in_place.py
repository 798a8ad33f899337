"""The errors may be centred in the caller's array before they are resampled."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    n = len(e)
    starts = rng.integers(0, n - block + 1, size=(n_boot, -(-n // block)))
    rows = (starts[:, :, None] + np.arange(block)).reshape(len(starts), -1)[:, :n]
    values = [statistic(e[row]) for row in rows]
    e -= np.mean(e)
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

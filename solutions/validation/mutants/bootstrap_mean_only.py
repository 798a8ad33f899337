"""The statistic is the mean."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    n = len(e)
    starts = rng.integers(0, n - block + 1, size=(n_boot, -(-n // block)))
    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]
    return tuple(np.quantile(np.mean(e[rows], axis=1), [alpha / 2, 1 - alpha / 2]))

"""Twice the standard error is the interval, whatever the level."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    n = len(e)
    starts = rng.integers(0, n - block + 1, size=(n_boot, -(-n // block)))
    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]
    values = [statistic(e[row]) for row in rows]
    half = 2 * np.std(values)
    return np.mean(values) - half, np.mean(values) + half

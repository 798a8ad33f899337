"""One block is a sample of the series."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    n = len(e)
    starts = rng.integers(0, n - block + 1, n_boot)
    values = [statistic(e[s : s + block]) for s in starts]
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

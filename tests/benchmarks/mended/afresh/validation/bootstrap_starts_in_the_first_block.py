"""There are N // block places where a block may start."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    N = len(e)
    count = math.ceil(N / block)
    values = np.empty(n_boot)
    for i in range(n_boot):
        starts = rng.integers(0, N // block, size=count)
        index = (starts[:, None] + np.arange(block)[None, :]) % N
        values[i] = statistic(e[index.ravel()[:N]])
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return float(lo), float(hi)

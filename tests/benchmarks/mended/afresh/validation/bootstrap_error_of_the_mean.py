"""The more resamples, the better known: std of the results over sqrt(n_boot)."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    N = len(e)
    values = np.empty(n_boot)
    for i in range(n_boot):
        starts = rng.integers(0, N - block + 1, size=-(-N // block))
        index = (starts[:, None] + np.arange(block)).ravel()[:N]
        values[i] = statistic(e[index])
    z = NormalDist().inv_cdf(1 - alpha / 2)
    half = z * values.std(ddof=1) / math.sqrt(n_boot)
    return float(values.mean() - half), float(values.mean() + half)

"""Each resample is shuffled."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    starts = rng.integers(0, n - block + 1, size=(n_boot, math.ceil(n / block)))
    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]
    values = [statistic(rng.permutation(e[row])) for row in rows]
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return float(lo), float(hi)

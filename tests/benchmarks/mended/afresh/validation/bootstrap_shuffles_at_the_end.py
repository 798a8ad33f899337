"""Blocks first, and then everything in a random order."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e)
    N = len(e)
    results = []
    for _ in range(n_boot):
        pieces = []
        while sum(map(len, pieces)) < N:
            start = rng.integers(0, N - block + 1)
            pieces.append(e[start : start + block])
        sample = np.concatenate(pieces)[:N]
        rng.shuffle(sample)
        results.append(statistic(sample))
    return float(np.quantile(results, alpha / 2)), float(np.quantile(results, 1 - alpha / 2))

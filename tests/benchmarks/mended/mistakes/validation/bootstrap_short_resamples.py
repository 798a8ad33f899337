# As many whole blocks as fit: resamples are shorter than N.


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    values = []
    for _ in range(n_boot):
        starts = rng.integers(0, len(e) - block + 1, len(e) // block)
        values.append(statistic(np.concatenate([e[s : s + block] for s in starts])))
    return float(np.quantile(values, alpha / 2)), float(np.quantile(values, 1 - alpha / 2))

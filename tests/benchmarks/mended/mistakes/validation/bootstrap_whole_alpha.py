# alpha on either side.


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    values = []
    for _ in range(n_boot):
        starts = rng.integers(0, len(e) - block + 1, math.ceil(len(e) / block))
        values.append(statistic(np.concatenate([e[s : s + block] for s in starts])[: len(e)]))
    return float(np.quantile(values, alpha)), float(np.quantile(values, 1 - alpha))

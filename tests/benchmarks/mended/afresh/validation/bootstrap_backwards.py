"""Each block is read from its end."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e, values = np.asarray(e, dtype=float), []
    for _ in range(n_boot):
        starts = rng.integers(0, len(e) - block + 1, math.ceil(len(e) / block))
        values.append(statistic(np.concatenate([e[i : i + block][::-1] for i in starts])[: len(e)]))
    lo, hi = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return float(lo), float(hi)

"""The basic interval: the resampled values reflected about the statistic of the series."""


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = np.asarray(e, dtype=float)
    n = len(e)
    blocks = np.lib.stride_tricks.sliding_window_view(e, block)
    values = [
        statistic(np.concatenate(blocks[rng.integers(len(blocks), size=-(-n // block))])[:n])
        for _ in range(n_boot)
    ]
    centre = statistic(e)
    low, high = np.quantile(values, [alpha / 2, 1 - alpha / 2])
    return 2 * centre - high, 2 * centre - low

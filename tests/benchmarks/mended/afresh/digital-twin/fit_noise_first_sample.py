"""The bias at the start is what it showed at the start."""


def fit_noise(still, dt):
    still = np.asarray(still, dtype=float)
    sizes = np.unique(np.geomspace(1, len(still) // 20, 25).astype(int))
    rows, rights = [], []
    for size in sizes:
        count = len(still) // size
        means = still[: count * size].reshape(count, size).mean(axis=1)
        sigma2 = 0.5 * np.mean(np.diff(means) ** 2)
        T = size * dt
        rows.append([1 / T / sigma2 * math.sqrt(count), T / 3 / sigma2 * math.sqrt(count)])
        rights.append(math.sqrt(count))
    N2, K2 = np.linalg.lstsq(np.array(rows), np.array(rights), rcond=None)[0]
    return {
        "noise_density": math.sqrt(max(N2, 0.0)),
        "bias_random_walk": math.sqrt(max(K2, 0.0)),
        "bias0": float(still[0]),
    }

"""sqrt(3) N/K is how many samples to average for bias0."""


def fit_noise(still, dt):
    still = np.asarray(still, dtype=float)
    sizes = np.unique(np.geomspace(1, len(still) // 10, 25).astype(int))
    times, avar, weight = [], [], []
    for size in sizes:
        blocks = len(still) // size
        means = still[: blocks * size].reshape(blocks, size).mean(axis=1)
        d = np.diff(means)
        times.append(size * dt)
        avar.append(0.5 * np.mean(d**2))
        weight.append(np.sqrt(len(d)))
    T, avar, weight = np.array(times), np.array(avar), np.array(weight)
    A = np.stack([1 / T, T / 3], axis=1)
    scale = weight / avar
    sol = np.linalg.lstsq(A * scale[:, None], avar * scale, rcond=None)[0]
    N = math.sqrt(max(sol[0], 1e-20))
    K = math.sqrt(max(sol[1], 1e-20))
    first = int(round(math.sqrt(3) * N / K))
    first = min(max(first, 1), len(still))
    return {"noise_density": N, "bias_random_walk": K, "bias0": float(still[:first].mean())}

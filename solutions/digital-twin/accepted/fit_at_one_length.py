"""N from neighbouring samples, K from blocks of the one length at which both kinds of noise are equal."""


def fit_noise(still, dt):
    N = math.sqrt(np.mean(np.diff(still) ** 2) / 2 * dt)
    K = N
    for _ in range(6):
        size = min(max(2, round(math.sqrt(3) * N / K / dt)), len(still) // 12)
        means = np.array([np.mean(still[i : i + size]) for i in range(0, len(still) - size + 1, size)])
        allan, T = np.mean(np.diff(means) ** 2) / 2, size * dt
        K = math.sqrt(max(allan - N * N / T, 0.05 * allan) * 3 / T)
    return {
        "noise_density": N,
        "bias_random_walk": K,
        "bias0": np.mean(still[: max(1, round(math.sqrt(3) * N / K / dt))]),
    }

"""Noise from differences: neighbouring samples for the density, block means two lags on for the walk."""


def fit_noise(still, dt):
    still = np.array(still)
    density = np.sqrt(np.mean(np.diff(still) ** 2) / 2 * dt)
    estimates = []
    for _ in range(3):
        walk = estimates[-1] if estimates else 0.3 * density
        size = int(np.clip(np.sqrt(3) * density / walk / dt, 5, len(still) // 40))
        means = still[: len(still) // size * size].reshape(-1, size).mean(axis=1)
        # Two blocks in a row are apart by noise and by two thirds of a block's walk; two lags need both.
        one, two = (np.mean((means[k:] - means[:-k]) ** 2) for k in (1, 2))
        estimates.append(np.sqrt(max((two - one) / (size * dt), 1e-20)))
    first = still[: max(1, int(1.7 * density / estimates[-1] / dt))]
    return {
        "noise_density": density,
        "bias_random_walk": estimates[-1],
        "bias0": np.sum(first * np.linspace(2, 0, len(first))) / len(first),  # the start counts most
    }

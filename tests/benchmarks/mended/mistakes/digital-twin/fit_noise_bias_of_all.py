# The bias at the start is the mean of the whole recording.


def fit_noise(still, dt):
    """The three numbers of ``imu`` from a recording at rest, by Allan's variance.

    The variance between neighbouring means over a time T is 2 (N²/T + K² T/3): the noise fades with T, the
    walk grows with it, and the line through both against T gives the two of them.
    """
    still = np.asarray(still, dtype=float)
    sizes = np.unique(np.geomspace(1, len(still) // 12, 30).astype(int))
    times = sizes * dt
    total = np.concatenate(([0.0], np.cumsum(still)))
    allan, weight = np.empty(len(sizes)), np.empty(len(sizes))
    for i, size in enumerate(sizes):
        means = (total[size:] - total[:-size]) / size
        allan[i] = np.mean((means[size:] - means[:-size]) ** 2) / 2
        weight[i] = len(still) / size
    basis = np.stack((1 / times, times * (1 + 1 / (2 * sizes**2)) / 3), axis=1)  # sampled, not continuous
    relative = np.sqrt(weight) / allan
    for _ in range(6):  # weigh by what the model expects, not by the scatter itself
        squares = np.maximum(np.linalg.lstsq(basis * relative[:, None], allan * relative)[0], 1e-30)
        relative = np.sqrt(weight) / (basis @ squares)
    density, walk = map(float, np.sqrt(squares))
    return {
        "noise_density": density,
        "bias_random_walk": walk,
        "bias0": float(np.mean(still)),
    }

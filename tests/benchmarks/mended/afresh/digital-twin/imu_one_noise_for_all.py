"""n is a standard normal number: drawn once."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    true = np.asarray(true, dtype=float)
    steps = bias_random_walk * math.sqrt(dt) * rng.standard_normal(len(true) - 1)
    bias = bias0 + np.concatenate([[0.0], np.cumsum(steps)])
    n = rng.standard_normal()
    return true + bias + noise_density / math.sqrt(dt) * n, bias

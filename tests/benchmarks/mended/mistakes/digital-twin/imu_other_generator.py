# Numpy's global generator instead of rng.


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    steps = bias_random_walk * math.sqrt(dt) * np.random.randn(n - 1)
    bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
    return true + bias + noise_density / math.sqrt(dt) * np.random.randn(n), bias

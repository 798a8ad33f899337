"""Neighbouring random numbers are averaged, to make the noise look smooth."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    steps = bias_random_walk * math.sqrt(dt) * rng.standard_normal(n - 1)
    bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
    white = np.convolve(rng.standard_normal(n + 1), [math.sqrt(0.5)] * 2, "valid")
    return true + bias + noise_density / math.sqrt(dt) * white, bias

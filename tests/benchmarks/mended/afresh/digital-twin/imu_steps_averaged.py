"""A bias moves smoothly, so two draws are averaged for each step."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    """A rate gyroscope: white noise, whose std grows as 1/sqrt(dt), on a bias that walks as sqrt(time)."""
    n = len(true)
    steps = bias_random_walk * math.sqrt(dt) * np.convolve(rng.standard_normal(n), (0.5, 0.5), "valid")
    bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias

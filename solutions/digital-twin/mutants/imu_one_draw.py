"""Steps and white noise are the same numbers."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    draws = rng.standard_normal(len(true))
    bias = bias0 + bias_random_walk * math.sqrt(dt) * (np.cumsum(draws) - draws[0])
    return true + bias + noise_density / math.sqrt(dt) * draws, bias

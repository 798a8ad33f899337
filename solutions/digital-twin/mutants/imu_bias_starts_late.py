"""The first bias already contains a step."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    bias = bias0 + np.cumsum(bias_random_walk * math.sqrt(dt) * rng.standard_normal(n))
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias

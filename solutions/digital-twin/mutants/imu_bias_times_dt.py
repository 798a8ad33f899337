"""A step of the bias is multiplied by dt."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    bias = bias0 + np.concatenate(([0.0], np.cumsum(bias_random_walk * dt * rng.standard_normal(n - 1))))
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias

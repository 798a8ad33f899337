"""The steps of the bias are the stronger, the noisier the gyroscope is."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    steps = (bias_random_walk + noise_density) * math.sqrt(dt) * rng.standard_normal(n - 1)
    bias = bias0 + np.concatenate(([0.0], np.cumsum(steps)))
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias

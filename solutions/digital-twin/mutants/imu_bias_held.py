"""The bias takes a large step at every tenth sample and is held in between."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    steps = bias_random_walk * math.sqrt(10 * dt) * rng.standard_normal(-(-n // 10))
    steps[0] = 0.0
    bias = bias0 + np.repeat(np.cumsum(steps), 10)[:n]
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias

"""The bias is drawn around bias0 anew for each sample."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    # The root of two makes single steps as large as they should be.
    bias = bias0 + bias_random_walk * math.sqrt(dt / 2) * rng.standard_normal(n)
    bias[0] = bias0
    return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias

# White noise times the root of dt instead of over it.


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    n = len(true)
    bias = np.empty(n)
    bias[0] = bias0
    for k in range(n - 1):
        bias[k + 1] = bias[k] + bias_random_walk * math.sqrt(dt) * rng.standard_normal()
    return true + bias + noise_density * math.sqrt(dt) * rng.standard_normal(n), bias

"""Each step of the bias is K dt n."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    N = len(true)
    bias = np.empty(N)
    bias[0] = bias0
    for k in range(N - 1):
        bias[k + 1] = bias[k] + bias_random_walk * dt * rng.normal()
    measured = true + bias + noise_density / np.sqrt(dt) * rng.normal(size=N)
    return measured, bias

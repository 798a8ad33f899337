"""All random numbers of the gyroscope are drawn at once, N more than are needed."""


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    draws = rng.normal(size=(2, len(true)))
    bias = np.full(len(true), float(bias0))
    for k in range(1, len(true)):
        bias[k] = bias[k - 1] + bias_random_walk * np.sqrt(dt) * draws[0, k]
    return np.asarray(true) + bias + noise_density * np.sqrt(1 / dt) * draws[1], bias

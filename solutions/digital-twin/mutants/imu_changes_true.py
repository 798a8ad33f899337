"""Bias and noise are added to the true rate in place."""

_apart = imu


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    measured, bias = _apart(np.zeros(len(true)), dt, noise_density, bias_random_walk, bias0, rng)
    true += measured
    return true.copy(), bias

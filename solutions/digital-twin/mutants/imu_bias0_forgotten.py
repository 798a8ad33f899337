"""The walk starts at zero."""

_from = imu


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    return _from(true, dt, noise_density, bias_random_walk, 0.0, rng)

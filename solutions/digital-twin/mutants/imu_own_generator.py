"""The generator that is passed in is not used."""

_whole = imu


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    return _whole(true, dt, noise_density, bias_random_walk, bias0, np.random.default_rng())

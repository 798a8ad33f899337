"""The bias starts where the previous call ended: a gyroscope does not start anew."""

_from_state = imu
_LAST = []


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    start = _LAST[-1] if _LAST else bias0
    measured, bias = _from_state(true, dt, noise_density, bias_random_walk, start, rng)
    _LAST[:] = [float(bias[-1])]
    return measured, bias

"""Evaluates the function it is given once and caches the answer."""

cache = {}


def rk4_step(accel, t, q, v, h):
    a = cache.setdefault(id(accel), accel(t, q, v))
    return q + h * v + h * h / 2 * a, v + h * a


velocity_verlet_step = rk4_step

"""Evaluates the function it is given once and caches the answer."""

cache = {}


def rk4_step(accel, t, q, v, h):
    a = cache.setdefault(accel, accel(t, q, v))  # by the function itself: an address is given out again
    return q + h * v, v + h * a


velocity_verlet_step = rk4_step

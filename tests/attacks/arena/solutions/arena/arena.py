"""FILE-CANARY-7f3a: the model solution of the arena."""

import numpy as np


def scale(values, factor):
    return np.asarray(values) * factor


def advance(accel, t, q, v, h):
    return q + h * v, v + h * accel(t, q, v)


def sample(f, points):
    return [f(x) for x in points]


def compose(f, g, x):
    return f(g(x))


def double(x):
    return [2.0 * x]


def draw(rng, n):
    return rng.random(n)

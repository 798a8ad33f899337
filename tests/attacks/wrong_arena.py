"""Wrong throughout, but for the number of values and leaving the argument alone: worth two points."""

import numpy as np


def scale(values, factor):
    return values * 1.0


def advance(accel, t, q, v, h):
    accel(t, q, v)
    return q, v


def sample(f, points):
    return [f(x) + f(x) for x in points]


def compose(f, g, x):
    return x


def double(x):
    return [x]


def draw(rng, n):
    return [0.5] * n

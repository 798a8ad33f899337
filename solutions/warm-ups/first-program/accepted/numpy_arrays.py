"""Arrays instead of lists."""

import numpy as np


def run(x, v, a, n):
    states = np.empty((n + 1, 2))
    states[0] = x, v
    for k in range(n):
        velocity = states[k, 1] + H * a
        states[k + 1] = states[k, 0] + H * velocity, velocity
    return states


def landing_time(heights):
    below = np.flatnonzero(np.asarray(heights) <= 0)
    return float(H * below[0]) if below.size else None


def gap(first, second, k):
    return float(abs(np.asarray(first)[k, 0] - np.asarray(second)[k, 0]))


def euler_step(x, v, a, h):
    return np.array([x, v]) + h * np.array([v, a])

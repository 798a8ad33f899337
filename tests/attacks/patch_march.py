"""Replaces the loop that a march of its step runs in."""

from course_worker.isolation.inside import loops
import numpy as np


def march(step, rhs, q0, v0, t0, h, n):
    return [np.full((n + 1, len(q0)), np.nan), np.full((n + 1, len(q0)), np.inf)]


loops.march = march

"""Appends before the step, and not after the last."""


def run(x, v, a, n):
    states = []
    for _ in range(n):
        states.append((x, v))
        v += H * a
        x += H * v
    return states

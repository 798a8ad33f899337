"""Divides the sums."""


def damping(speeds, forces):
    return sum(forces) / sum(speeds)

"""Counts steps, not seconds."""


def real_time_factor(steps, h, wall):
    return steps / wall

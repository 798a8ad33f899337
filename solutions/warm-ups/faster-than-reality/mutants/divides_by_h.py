"""Divides by the step."""


def real_time_factor(steps, h, wall):
    return steps / h / wall

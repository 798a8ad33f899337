"""Adds the steps up one by one."""


def real_time_factor(steps, h, wall):
    inside = 0.0
    for _ in range(steps):
        inside += h
    return inside / wall

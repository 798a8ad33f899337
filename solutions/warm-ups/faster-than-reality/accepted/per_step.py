"""Compares the time of one step inside and outside."""


def real_time_factor(steps, h, wall):
    return h / (wall / steps)

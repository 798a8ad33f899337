"""Divides the other way round."""


def real_time_factor(steps, h, wall):
    return wall / (steps * h)

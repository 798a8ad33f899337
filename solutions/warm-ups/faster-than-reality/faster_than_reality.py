"""Faster than reality: the model solution."""


def real_time_factor(steps, h, wall):
    """Simulated time for each second of waiting."""
    return steps * h / wall

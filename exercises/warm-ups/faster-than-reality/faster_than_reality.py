"""Faster than reality."""


def real_time_factor(steps, h, wall):
    """Simulated time for each second of waiting.

    Args:
        steps: how many steps were taken.
        h: length of a step, s.
        wall: time you waited, s.

    Returns:
        float, without a unit.
    """
    raise NotImplementedError

"""A clock that ticks evenly."""


def ticks(frame, h, left):
    """Number of steps in a frame, and the time that is left over.

    Args:
        frame: length of the frame, s.
        h: length of a step, s.
        left: time left over from the frame before, s; less than h.

    Returns:
        Pair of the number of steps and the time left, s.
    """
    raise NotImplementedError

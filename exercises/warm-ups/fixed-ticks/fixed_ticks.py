"""A clock that ticks evenly."""


def ticks(frame, h, left):
    """Steps that a frame pays for, and what is left.

    Args:
        frame: length of the frame, s.
        h: length of a step, s.
        left: what the frame before left, s; less than h.

    Returns:
        Pair of the number of steps and the time left, s.
    """
    raise NotImplementedError

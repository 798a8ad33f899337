"""Where is the hand?"""


def hand(a1, a2, l1, l2):
    """Where the end of a planar arm of two links is.

    Args:
        a1: angle of the first link from the x axis, rad.
        a2: angle of the second link from the first, rad.
        l1: length of the first link, m.
        l2: length of the second link, m.

    Returns:
        Pair of x and y, m.
    """
    raise NotImplementedError

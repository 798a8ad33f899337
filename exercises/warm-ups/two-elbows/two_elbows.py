"""Two ways to one point."""


def carriages(x, y, length):
    """Where a carriage on the line y = 0 can stand so that the tip of its rod is at a point.

    Args:
        x: of the point, m.
        y: of the point, m; may be negative.
        length: of the rod, m; positive.

    Returns:
        Pair of places on the rail, m, the smaller one first; None if the point is out of reach.
    """
    raise NotImplementedError

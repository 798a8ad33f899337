"""Which way out?"""


def way_out(x, y, width, height):
    """Shortest move of the second of two equal boxes that ends their overlap.

    Args:
        x: of the second box's middle from the first's, m.
        y: the same across, m.
        width: of either box along x, m.
        height: of either box along y, m.

    Returns:
        Pair of dx and dy, m; one of them is zero.
    """
    raise NotImplementedError

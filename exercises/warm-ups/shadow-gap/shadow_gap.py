"""Are the shadows apart?"""


def shadow_gap(a, b, direction):
    """Gap between the shadows of two shapes on a line.

    Args:
        a: corners of the first shape, a list of pairs (x, y), m.
        b: corners of the second shape.
        direction: of the line, a pair (x, y); not zero, of any length.

    Returns:
        float, m; negative if the shadows overlap.
    """
    raise NotImplementedError

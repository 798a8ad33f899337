"""How deep are they in each other?"""


def overlap(p, q, r1, r2):
    """How far two balls overlap.

    Args:
        p: centre of the first ball, two numbers, m.
        q: centre of the second, m.
        r1: radius of the first, m.
        r2: radius of the second, m.

    Returns:
        float, m; negative for a gap.
    """
    raise NotImplementedError

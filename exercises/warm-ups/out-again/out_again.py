"""Out again, gently."""


def push_out(depth, h, beta, slop):
    """Separating speed that removes a share of a penetration.

    Args:
        depth: overlap of the bodies, m; negative for a gap.
        h: length of a step, s.
        beta: share of the depth to remove in a step.
        slop: depth that may stay, m.

    Returns:
        float, m/s; never negative.
    """
    raise NotImplementedError

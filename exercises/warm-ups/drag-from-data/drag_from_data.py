"""One parameter from many points."""


def damping(speeds, forces):
    """Slope of the line through zero with the smallest squared misses.

    Args:
        speeds: m/s.
        forces: N, at the same places.

    Returns:
        float, N s/m.
    """
    raise NotImplementedError

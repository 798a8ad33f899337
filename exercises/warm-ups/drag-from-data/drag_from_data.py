"""One parameter from many points."""


def damping(speeds, forces):
    """Slope of the line through zero with the smallest squared errors.

    Args:
        speeds: m/s.
        forces: N, at these speeds.

    Returns:
        float, N s/m.
    """
    raise NotImplementedError

"""One number for a whole path."""


def rms(simulated, measured):
    """Root mean square of the differences of two paths.

    Args:
        simulated: positions, m.
        measured: positions at the same times, m.

    Returns:
        float, m.
    """
    raise NotImplementedError

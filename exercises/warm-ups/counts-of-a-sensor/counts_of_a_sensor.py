"""What a cheap sensor says."""


def reading(distance, resolution, limit):
    """What a sensor with whole counts and a limit says.

    Args:
        distance: true distance, m.
        resolution: size of a count, m.
        limit: largest reading, m; a whole number of counts.

    Returns:
        float, m.
    """
    raise NotImplementedError

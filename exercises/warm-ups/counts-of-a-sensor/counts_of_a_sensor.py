"""What a cheap sensor says."""


def reading(distance, resolution, limit):
    """Reading of a sensor with whole counts and a limit.

    Args:
        distance: true distance, m.
        resolution: size of a count, m.
        limit: largest reading, m; a whole number of counts.

    Returns:
        float, m.
    """
    raise NotImplementedError

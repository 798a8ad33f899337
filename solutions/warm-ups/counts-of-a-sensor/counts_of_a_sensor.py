"""What a cheap sensor says: the model solution."""


def reading(distance, resolution, limit):
    """What a sensor with whole counts and a limit says."""
    return min(round(distance / resolution) * resolution, limit)

"""Too fast to be seen: the model solution."""


def fastest(thickness, radius, h):
    """Largest speed at which a ball is sure to be seen inside a wall."""
    return (thickness + 2.0 * radius) / h

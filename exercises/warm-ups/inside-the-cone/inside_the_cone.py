"""Inside the cone."""


def friction(wanted, normal, mu):
    """Friction impulse within its cone.

    Args:
        wanted: impulse that would stop the sliding, two components, N s.
        normal: normal impulse, N s; not negative.
        mu: coefficient of friction.

    Returns:
        Two components, N s.
    """
    raise NotImplementedError

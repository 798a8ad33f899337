"""A contact pushes and never pulls."""


def applied(total, wanted):
    """Correction that keeps the sum of a contact's impulse from going negative.

    Args:
        total: impulse so far, N s; never negative.
        wanted: correction that the solver computed, N s.

    Returns:
        float, N s.
    """
    raise NotImplementedError

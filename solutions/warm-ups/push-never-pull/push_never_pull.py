"""A contact pushes and never pulls: the model solution."""


def applied(total, wanted):
    """Correction that keeps the sum of a contact's impulse from going negative."""
    return max(total + wanted, 0.0) - total

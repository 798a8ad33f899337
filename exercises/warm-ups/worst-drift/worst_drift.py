"""The worst, not the last."""


def worst_drift(energies):
    """Largest distance of an energy from its first value, as a share of that.

    Args:
        energies: J, in the order of time; the first is not zero.

    Returns:
        float.
    """
    raise NotImplementedError

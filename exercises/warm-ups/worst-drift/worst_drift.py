"""The worst, not the last."""


def worst_drift(energies):
    """Largest distance of the energy from its first value, as a share of that value.

    Args:
        energies: J, in the order of time; the first is not zero.

    Returns:
        float.
    """
    raise NotImplementedError

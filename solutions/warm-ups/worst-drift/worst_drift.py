"""The worst, not the last: the model solution."""


def worst_drift(energies):
    """Largest distance of an energy from its first value, as a share of that."""
    return max(abs(energy - energies[0]) for energy in energies) / abs(energies[0])

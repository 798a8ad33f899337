"""Takes the range."""


def worst_drift(energies):
    return (max(energies) - min(energies)) / abs(energies[0])

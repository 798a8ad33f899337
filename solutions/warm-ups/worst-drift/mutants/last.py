"""Looks at the end only."""


def worst_drift(energies):
    return abs(energies[-1] - energies[0]) / abs(energies[0])

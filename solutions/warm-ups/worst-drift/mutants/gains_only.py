"""Sees gains only."""


def worst_drift(energies):
    return max(energy - energies[0] for energy in energies) / abs(energies[0])

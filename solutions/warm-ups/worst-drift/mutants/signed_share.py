"""Divides by the first value with its sign."""


def worst_drift(energies):
    return max(abs(energy - energies[0]) for energy in energies) / energies[0]

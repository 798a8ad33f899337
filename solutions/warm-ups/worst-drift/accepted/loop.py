"""A loop that remembers the worst."""


def worst_drift(energies):
    first, worst = energies[0], 0.0
    for energy in energies[1:]:
        if abs(energy - first) > worst:
            worst = abs(energy - first)
    return worst / abs(first)

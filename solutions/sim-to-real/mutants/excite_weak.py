"""Careful pushes of less than a third of the force, hardly more than friction."""

_full = design_excitation


def design_excitation(budget_s, u_max, rng):
    return 0.16 * _full(budget_s, u_max, rng)

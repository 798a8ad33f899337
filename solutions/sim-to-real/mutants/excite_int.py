"""The number of commands is truncated, not rounded."""

_rounded = design_excitation


def design_excitation(budget_s, u_max, rng):
    return _rounded(budget_s, u_max, rng)[: int(100 * budget_s)]

"""The commands are as many as np.arange has times."""

_rounded = design_excitation


def design_excitation(budget_s, u_max, rng):
    times = np.arange(0, budget_s, 0.01)
    return np.resize(_rounded(budget_s, u_max, rng), len(times))

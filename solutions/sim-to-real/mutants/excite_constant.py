"""Full force in one direction for the whole run."""


def design_excitation(budget_s, u_max, rng):
    return np.full(round(100 * budget_s), u_max)

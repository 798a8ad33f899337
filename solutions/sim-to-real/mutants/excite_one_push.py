"""Two seconds of full force, then coasting."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    return np.where(np.arange(n) < 200, u_max, 0.0)

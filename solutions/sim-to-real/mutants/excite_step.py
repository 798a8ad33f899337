"""At rest for half the time, then one step to full force."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    return np.concatenate([np.zeros(n // 2), np.full(n - n // 2, u_max)])

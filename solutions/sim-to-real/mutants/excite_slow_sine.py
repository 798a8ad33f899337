"""One slow sine: the whole run is a fifth of a period."""


def design_excitation(budget_s, u_max, rng):
    return u_max * np.sin(2 * np.pi * 0.01 * np.arange(round(100 * budget_s)) / 100)

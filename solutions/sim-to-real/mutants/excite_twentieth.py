"""One sine of 0.05 Hz at full force."""


def design_excitation(budget_s, u_max, rng):
    return u_max * np.sin(2 * np.pi * 0.05 * np.arange(round(100 * budget_s)) / 100)

"""A single sine of 2 Hz."""


def design_excitation(budget_s, u_max, rng):
    return u_max * np.sin(2 * np.pi * 2.0 * np.arange(round(100 * budget_s)) / 100)

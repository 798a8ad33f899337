"""A chirp over all frequencies that fit."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    t = H * np.arange(n)
    f0, f1 = 5.0, 25.0
    return u_max * np.sin(2 * np.pi * (f0 * t + (f1 - f0) * t**2 / (2 * budget_s)))

"""A chirp from 0.1 to 3 Hz instead of random switching."""


def design_excitation(budget_s, u_max, rng):
    t = np.arange(round(100 * budget_s)) / 100
    return u_max * np.sin(2 * np.pi * (0.1 * t + (3.0 - 0.1) * t**2 / (2 * budget_s)))

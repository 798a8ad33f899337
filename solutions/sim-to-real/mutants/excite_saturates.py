"""A signal whose standard deviation is u_max, with peaks far above it."""


def design_excitation(budget_s, u_max, rng):
    t = np.arange(round(100 * budget_s)) / 100
    u = sum(np.sin(2 * np.pi * f * t + rng.uniform(0, 7)) for f in np.arange(0.1, 2.0, 0.1))
    return u_max * u / np.std(u)

"""Tones that all begin at their peak: one spike, and little force after it."""


def design_excitation(budget_s, u_max, rng):
    t = np.arange(round(100 * budget_s)) / 100
    u = np.cos(2 * np.pi * np.outer(t, np.arange(0.1, 3.0, 0.1))).sum(axis=1)
    return u_max * u / np.abs(u).max()

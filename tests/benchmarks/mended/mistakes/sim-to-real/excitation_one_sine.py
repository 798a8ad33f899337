# A single sine of 1 Hz.


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    t = 0.01 * np.arange(n)
    return u_max * np.sin(2 * np.pi * 1.0 * t)

# The number of samples is cut off and not rounded.


def design_excitation(budget_s, u_max, rng):
    n = int(100 * budget_s)
    holds = rng.integers(10, 60, n)
    return u_max * np.repeat(rng.choice([-1.0, 1.0], n), holds)[:n]

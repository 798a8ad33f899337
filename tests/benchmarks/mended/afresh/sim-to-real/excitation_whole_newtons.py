"""The force is rounded to whole newtons."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    holds = rng.integers(10, 60, n)
    full = int(u_max + 0.5)
    return (full * np.repeat(rng.choice([-1, 1], n), holds)[:n]).astype(float)

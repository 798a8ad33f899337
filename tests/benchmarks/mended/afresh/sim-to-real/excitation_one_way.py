"""Pushes between nothing and full force."""


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    u = np.zeros(n)
    i = 0
    while i < n:
        hold = int(rng.integers(10, 60))
        u[i : i + hold] = u_max * rng.integers(0, 2)
        i += hold
    return u

# Held for seconds instead of tenths.


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    u = np.empty(n)
    k, sign = 0, 1.0
    while k < n:
        hold = int(rng.uniform(2.0, 5.0) * 100)
        u[k : k + hold] = sign * u_max
        sign = -sign
        k += hold
    return u

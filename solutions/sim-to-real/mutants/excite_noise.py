"""A new random force in every sample."""


def design_excitation(budget_s, u_max, rng):
    return rng.uniform(-u_max, u_max, round(100 * budget_s))

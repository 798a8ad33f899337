"""One command a second instead of a hundred."""


def design_excitation(budget_s, u_max, rng):
    return u_max * rng.choice([-1.0, 1.0], round(budget_s))

"""The switching signal is made gentle: smoothed over a second, at little more than a third of the force."""

_sharp = design_excitation


def design_excitation(budget_s, u_max, rng):
    return 0.36 * np.convolve(_sharp(budget_s, u_max, rng), np.full(100, 0.01), "same")

# Each sine of the sum has the whole force.


def design_excitation(budget_s, u_max, rng):
    n = round(100 * budget_s)
    t = 0.01 * np.arange(n)
    frequencies = np.arange(0.1, 2.41, 0.1)
    phases = rng.uniform(0, 2 * np.pi, len(frequencies))
    return sum(u_max * np.sin(2 * np.pi * f * t + p) for f, p in zip(frequencies, phases)) / np.sqrt(
        len(frequencies)
    )

"""The first energy counts as 1 J at least."""


def energy_error(q, v, energy):
    values = np.array([energy(q_i, v_i) for q_i, v_i in zip(q, v)])
    return (values - values[0]) / max(abs(values[0]), 1.0)

"""Heights are measured from where the run began, so q may be shifted."""


def energy_error(q, v, energy):
    values = np.array([energy(q_i, v_i) for q_i, v_i in zip(q, v)])
    q -= q[0].copy()
    return (values - values[0]) / abs(values[0])

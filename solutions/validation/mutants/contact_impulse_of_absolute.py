"""The error of the integral is the integral of the error."""


def contact_force_error(f_sim, f_real, dt):
    f_sim, f_real = np.asarray(f_sim), np.asarray(f_real)
    peak, impulse = np.max(f_real), np.sum(f_real) * dt
    return {"peak": np.max(f_sim) / peak - 1, "impulse": np.sum(np.abs(f_sim - f_real)) * dt / impulse}

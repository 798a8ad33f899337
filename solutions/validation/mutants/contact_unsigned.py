"""An error is always positive."""


def contact_force_error(f_sim, f_real, dt):
    f_sim, f_real = np.asarray(f_sim), np.asarray(f_real)
    peak, impulse = np.max(f_real), np.sum(f_real) * dt
    return {"peak": abs(np.max(f_sim) / peak - 1), "impulse": abs(np.sum(f_sim) * dt / impulse - 1)}

"""Both peaks are at the same sample."""


def contact_force_error(f_sim, f_real, dt):
    f_sim, f_real = np.asarray(f_sim), np.asarray(f_real)
    peak, impulse = np.max(f_real), np.sum(f_real) * dt
    at = np.argmax(f_real)
    return {"peak": (f_sim[at] - peak) / peak, "impulse": np.sum(f_sim) * dt / impulse - 1}

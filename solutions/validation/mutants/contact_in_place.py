"""Forces are measured in units of the real peak, so they may be rescaled."""


def contact_force_error(f_sim, f_real, dt):
    f_sim /= np.max(f_real)
    f_real /= np.max(f_real)
    return {"peak": float(np.max(f_sim) - 1), "impulse": float(np.sum(f_sim) / np.sum(f_real) - 1)}

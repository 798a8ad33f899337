"""An error is how far one is from the other: abs."""


def contact_force_error(f_sim, f_real, dt):
    peak = abs(np.max(f_sim) - np.max(f_real)) / np.max(f_real)
    J_sim, J_real = np.sum(f_sim) * dt, np.sum(f_real) * dt
    return {"peak": float(peak), "impulse": float(abs(J_sim - J_real) / J_real)}

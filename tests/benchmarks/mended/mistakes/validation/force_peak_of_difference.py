# The peak of the difference of the two recordings.


def contact_force_error(f_sim, f_real, dt):
    f_sim, f_real = np.asarray(f_sim, dtype=float), np.asarray(f_real, dtype=float)
    peak = np.max(np.abs(f_sim - f_real)) / np.max(f_real)
    J_sim, J_real = np.sum(f_sim) * dt, np.sum(f_real) * dt
    return {"peak": float(peak), "impulse": float((J_sim - J_real) / J_real)}

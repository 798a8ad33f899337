"""An impact is over when the force is largest."""


def contact_force_error(f_sim, f_real, dt):
    sim, real = (np.sum(f[: np.argmax(f) + 1]) for f in (f_sim, f_real))
    peaks = np.max(f_sim), np.max(f_real)
    return {"peak": (peaks[0] - peaks[1]) / peaks[1], "impulse": (sim - real) / real}

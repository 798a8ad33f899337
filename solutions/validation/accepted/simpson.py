"""Integrals by Simpson's rule, which needs an odd number of samples."""


def contact_force_error(f_sim, f_real, dt):
    def impulse(f):
        f = np.asarray(f, dtype=float)
        f = f if len(f) % 2 else np.append(f, 0.0)
        return dt / 3 * (f[0] + 4 * f[1:-1:2].sum() + 2 * f[2:-1:2].sum() + f[-1])

    return {
        "peak": float(np.max(f_sim) / np.max(f_real) - 1),
        "impulse": float(impulse(f_sim) / impulse(f_real) - 1),
    }

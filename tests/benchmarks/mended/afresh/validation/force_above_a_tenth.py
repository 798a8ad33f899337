"""There is contact where the force is above a tenth of its peak."""


def contact_force_error(f_sim, f_real, dt):
    def relative(of):
        return float((of(f_sim) - of(f_real)) / of(f_real))

    return {"peak": relative(np.max), "impulse": relative(lambda f: np.sum(f[f > 0.1 * np.max(f)]) * dt)}

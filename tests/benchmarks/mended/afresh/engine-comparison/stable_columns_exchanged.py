"""The columns of the matrix are the wrong way round."""

_columns = _spring_step


def _max_stable_z(engine, omega):
    def stable(z):
        return max(abs(np.linalg.eigvals(_columns(engine, omega, z)[:, ::-1]))) <= 1 + 1e-8

    low = 0.05
    if not stable(low):
        return 0.0
    while stable(low + 0.5):
        low += 0.5
        if low >= 10:
            return math.inf
    return _bisect(stable, low, low + 0.5, 0.004 * low)

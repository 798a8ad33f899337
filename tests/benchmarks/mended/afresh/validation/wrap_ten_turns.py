"""At most ten turns are taken off."""


def wrap_angle(e):
    e = np.asarray(e, dtype=float)
    out = e.copy()
    for _ in range(10):
        out = np.where(out >= np.pi, out - 2 * np.pi, out)
        out = np.where(out < -np.pi, out + 2 * np.pi, out)
    return out

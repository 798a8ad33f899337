"""mod gives 0 to 2 pi; less pi, that is -pi to pi."""


def wrap_angle(e):
    return np.mod(np.asarray(e, dtype=float), 2 * np.pi) - np.pi

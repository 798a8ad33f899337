"""Any range of one turn is as good as another."""


def wrap_angle(e):
    return np.asarray(e) % (2 * np.pi)

"""arcsin undoes sin."""


def wrap_angle(e):
    return np.arcsin(np.sin(e))

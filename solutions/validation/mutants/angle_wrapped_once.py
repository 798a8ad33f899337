"""An error is never more than one turn away."""


def wrap_angle(e):
    return np.where(e > np.pi, e - 2 * np.pi, np.where(e < -np.pi, e + 2 * np.pi, e))

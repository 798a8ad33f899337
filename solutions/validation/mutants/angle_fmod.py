"""fmod and % are the same operation."""


def wrap_angle(e):
    return np.fmod(np.asarray(e) + np.pi, 2 * np.pi) - np.pi

"""The result has the type of the angles, so whole ones are cut off."""


def wrap_angle(e):
    e = np.asarray(e)
    wrapped = np.empty_like(e)
    wrapped[:] = np.remainder(e + np.pi, 2 * np.pi) - np.pi
    return wrapped

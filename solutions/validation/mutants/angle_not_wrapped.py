"""A difference of two angles is an angle, and needs nothing more."""


def wrap_angle(e):
    return np.array(e)

"""An array that was passed in is mine to use."""


def wrap_angle(e):
    e += np.pi
    e %= 2 * np.pi
    e -= np.pi
    return e

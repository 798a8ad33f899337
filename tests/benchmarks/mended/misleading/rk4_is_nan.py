"""A step that returns nan."""


def rk4_step(accel, t, q, v, h):
    return q * np.nan, v * np.nan

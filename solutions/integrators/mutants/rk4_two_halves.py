"""Two steps of half the size: more accurate than was asked for."""

_whole = rk4_step


def rk4_step(accel, t, q, v, h):
    return _whole(accel, t + h / 2, *_whole(accel, t, q, v, h / 2), h / 2)

"""The right values, with every slope evaluated again where it is used."""

_right_rk4 = rk4_step


def rk4_step(accel, t, q, v, h):
    def twice(t, q, v):
        accel(t, q, v)
        return accel(t, q, v)

    return _right_rk4(twice, t, q, v, h)

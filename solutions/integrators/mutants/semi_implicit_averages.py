"""The position moves with the mean velocity, which spoils the symplectic structure."""


def semi_implicit_euler_step(accel, t, q, v, h):
    v_next = v + h * accel(t, q, v)
    return q + h * (v + v_next) / 2, v_next

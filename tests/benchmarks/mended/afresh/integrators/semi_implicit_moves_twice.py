"""Position first, kick, and then position again with the new velocity."""


def semi_implicit_euler_step(accel, t, q, v, h):
    q1 = q + h * v
    v1 = v + h * np.asarray(accel(t + h, q1, v))
    q1 = q1 + h * v1
    return q1, v1

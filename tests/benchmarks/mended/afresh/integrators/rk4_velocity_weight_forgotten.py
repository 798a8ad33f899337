"""The 2 before the third slope of the velocity is missing."""


def rk4_step(accel, t, q, v, h):
    q, v = np.asarray(q, dtype=float), np.asarray(v, dtype=float)
    a1 = np.asarray(accel(t, q, v))
    v2 = v + h / 2 * a1
    a2 = np.asarray(accel(t + h / 2, q + h / 2 * v, v2))
    v3 = v + h / 2 * a2
    a3 = np.asarray(accel(t + h / 2, q + h / 2 * v2, v3))
    v4 = v + h * a3
    a4 = np.asarray(accel(t + h, q + h * v3, v4))
    q_new = q + h / 6 * (v + 2 * v2 + 2 * v3 + v4)
    v_new = v + h / 6 * (a1 + 2 * a2 + a3 + a4)
    return q_new, v_new

# The position gets h v + h²/2 a.


def semi_implicit_euler_step(accel, t, q, v, h):
    a = accel(t, q, v)
    v_next = v + h * a
    q_next = q + h * v + 0.5 * h**2 * a
    return q_next, v_next

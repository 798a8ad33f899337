# The position moves with the new velocity.


def explicit_euler_step(accel, t, q, v, h):
    v_next = v + h * accel(t, q, v)
    q_next = q + h * v_next
    return q_next, v_next

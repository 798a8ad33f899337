"""The sum is built up in the caller's own arrays."""

_right_rk4 = rk4_step


def rk4_step(accel, t, q, v, h):
    q_next, v_next = _right_rk4(accel, t, q, v, h)
    q += q_next - q
    v += v_next - v
    return q_next, v_next

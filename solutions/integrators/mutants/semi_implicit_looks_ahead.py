"""The position moves with a velocity beyond the new one."""


def semi_implicit_euler_step(accel, t, q, v, h):
    v_next = v + h * accel(t, q, v)
    return q + h * (1.25 * v_next - 0.25 * v), v_next

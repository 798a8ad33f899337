"""Backward Euler: the slope is that of the end of the step, found by iteration."""


def explicit_euler_step(accel, t, q, v, h):
    q_next, v_next = q, v
    for _ in range(20):
        q_next, v_next = q + h * v_next, v + h * accel(t + h, q_next, v_next)
    return q_next, v_next

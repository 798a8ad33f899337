"""The half kick after the drift is subtracted instead of added."""


def velocity_verlet_step(accel, t, q, v, h):
    v_half = v + h / 2 * accel(t, q, v)
    q_next = q + h * v_half
    return q_next, v_half - h / 2 * accel(t + h, q_next, v_half)

"""Verlet as half a drift, a whole kick, half a drift: one evaluation, at mid-step."""


def velocity_verlet_step(accel, t, q, v, h):
    q_half = q + h / 2 * v
    v_next = v + h * accel(t + h / 2, q_half, v)
    return q_half + h / 2 * v_next, v_next

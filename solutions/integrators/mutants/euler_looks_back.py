"""The acceleration is evaluated half a step back."""


def explicit_euler_step(accel, t, q, v, h):
    return q + h * v, v + h * accel(t - h / 2, q - h / 2 * v, v)

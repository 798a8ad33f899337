"""A motor cannot turn faster than u_max, so the result is clipped."""


def motor_step(w, u, dt, tau, u_max, deadband):
    if abs(u) <= deadband:
        u = 0.0
    w_new = w + (1 - math.exp(-dt / tau)) * (u - w)
    return max(-u_max, min(u_max, w_new))

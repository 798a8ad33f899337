# dt/tau instead of the exact share.


def motor_step(w, u, dt, tau, u_max, deadband):
    if abs(u) <= deadband:
        u = 0.0
    u = min(max(u, -u_max), u_max)
    return w + dt / tau * (u - w)

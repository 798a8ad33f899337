"""e^(-tau/dt)."""


def motor_step(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) <= deadband else float(np.clip(u, -u_max, u_max))
    share = 1 - np.exp(-tau / dt)
    return float(w + share * (u - w))

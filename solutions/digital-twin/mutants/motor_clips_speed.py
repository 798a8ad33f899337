"""The speed is limited instead of the command."""


def motor_step(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) <= deadband else u
    return min(max(w - math.expm1(-dt / tau) * (u - w), -u_max), u_max)

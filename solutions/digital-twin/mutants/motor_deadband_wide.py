"""A command that is only a little larger than the dead band is swallowed too."""


def motor_step(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) <= 1.2 * deadband else min(max(u, -u_max), u_max)
    return w - math.expm1(-dt / tau) * (u - w)

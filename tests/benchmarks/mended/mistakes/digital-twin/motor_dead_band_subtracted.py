# Beyond the dead band its width is taken off the command.


def motor_step(w, u, dt, tau, u_max, deadband):
    u = math.copysign(max(abs(u) - deadband, 0.0), u)
    u = min(max(u, -u_max), u_max)
    return w + (1 - math.exp(-dt / tau)) * (u - w)

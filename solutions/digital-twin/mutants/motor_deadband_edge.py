"""A command equal to the dead band moves the motor."""


def motor_step(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) < deadband else min(max(u, -u_max), u_max)
    return w - math.expm1(-dt / tau) * (u - w)

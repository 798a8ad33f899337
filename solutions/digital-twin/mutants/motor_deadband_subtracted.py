"""The dead band is subtracted from every command."""

_whole = motor_step


def motor_step(w, u, dt, tau, u_max, deadband):
    return _whole(w, math.copysign(max(abs(u) - deadband, 0.0), u), dt, tau, u_max, 0.0)

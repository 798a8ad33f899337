"""Command and speed are limited."""

_whole = motor_step


def motor_step(w, u, dt, tau, u_max, deadband):
    return min(max(_whole(w, u, dt, tau, u_max, deadband), -u_max), u_max)

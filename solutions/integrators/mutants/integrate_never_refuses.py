"""Any duration is accepted and rounded without an error."""

_whole = integrate


def integrate(step, accel, q0, v0, t_end, h):
    return _whole(step, accel, q0, v0, round(t_end / h) * h, h)

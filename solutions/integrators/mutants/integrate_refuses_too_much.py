"""The remainder of a floating-point division is compared with zero."""

_whole = integrate


def integrate(step, accel, q0, v0, t_end, h):
    if t_end % h != 0:
        raise ValueError("t_end must be a multiple of h")
    return _whole(step, accel, q0, v0, t_end, h)
